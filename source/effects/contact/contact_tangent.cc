// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/effects/contact/contact_pairs.h>

#include <deal.II/base/symmetric_tensor.h>

#include <map>
#include <vector>

// The part of ContactPairs that makes the tangent.

namespace Morula
{
  template <int dim>
  void
  ContactPairs<dim>::add_products(
    const std::vector<double>              &of_rows,
    const std::vector<std::vector<double>> &columns,
    std::vector<double>                    &matrix)
  {
    const unsigned int n = of_rows.size(), m = columns[0].size();
    for (unsigned int i = 0; i < dim; ++i)
      for (unsigned int s = 0; s < n; ++s)
        for (unsigned int j = 0; j < dim; ++j)
          {
            double *const       row    = &matrix[((i * n + s) * dim + j) * m];
            const double *const column = columns[i * dim + j].data();
            const double        factor = of_rows[s];
            for (unsigned int t = 0; t < m; ++t)
              row[t] += factor * column[t];
          }
  }


  template <int dim>
  void
  ContactPairs<dim>::add_link(const unsigned int   link,
                              const WithStiffness &list,
                              const AddBlock      &add) const
  {
    // Pairs come in the order of their points b, so that those of one b
    // stand together.
    const unsigned int n = links_[link].rows.size(),
                       m = links_[link].columns.size();
    std::vector<std::vector<double>> columns(dim * dim);
    std::vector<double>              matrix(dim * n * dim * m, 0.), transposed;
    for (std::size_t first = 0, last; first < list.size(); first = last)
      {
        const unsigned int b = list[first].first->b;
        for (std::vector<double> &column : columns)
          column.assign(m, 0.);
        for (last = first; last < list.size() && list[last].first->b == b;
             ++last)
          {
            const std::vector<double> &of_c =
              points.points()[list[last].first->c].values;
            const Tensor<2, dim> &M = list[last].second;
            for (unsigned int i = 0; i < dim; ++i)
              for (unsigned int j = 0; j < dim; ++j)
                for (unsigned int t = 0; t < m; ++t)
                  columns[i * dim + j][t] -= M[i][j] * of_c[t];
          }
        add_products(points.points()[b].values, columns, matrix);
      }
    add(link, matrix);
    transposed.resize(matrix.size());
    for (unsigned int i = 0; i < dim * n; ++i)
      for (unsigned int j = 0; j < dim * m; ++j)
        transposed[j * dim * n + i] = matrix[i * dim * m + j];
    add(link + 1, transposed);
  }


  template <int dim>
  void
  ContactPairs<dim>::add_tangent(const std::vector<double> &u,
                                 const AddBlock            &add) const
  {
    // A pair's jump is w = Σ_s q_s ũ_s, with the values φ of b, and minus those
    // of c; its part is A M q qᵀ with M = κ D⊗D + k_t P, doc/theory.md (4.8l).
    // A point's block with itself needs only the sum of M over its pairs, and
    // that of b with all its partners in a group the sum of M φ_c: there are
    // far fewer points than pairs. The block of c with b is the transposed one.
    const std::vector<Tensor<1, dim>>      ways = displacements(u);
    std::map<unsigned int, Tensor<2, dim>> of_points;
    std::map<unsigned int, unsigned int>   group_of;
    std::vector<WithStiffness>             of_links(links_.size());
    for (const Pair &pair : pairs)
      if (pair.drag + pair.slow > 0. || gap(pair, ways) < 0.)
        {
          const Tensor<2, dim> M = stiffness(pair, ways);
          of_points[pair.b] += M;
          of_points[pair.c] += M;
          group_of[pair.b] = pair.group_b;
          group_of[pair.c] = pair.group_c;
          of_links[pair.link].emplace_back(&pair, M);
        }
    std::vector<std::vector<double>>                  columns(dim * dim);
    std::vector<double>                               matrix;
    std::map<unsigned int, std::vector<unsigned int>> of_groups;
    for (const auto &[k, group] : group_of)
      of_groups[group].push_back(k);
    for (const auto &[group, list] : of_groups)
      {
        const unsigned int m = links_[group].rows.size();
        matrix.assign(dim * m * dim * m, 0.);
        for (const unsigned int k : list)
          {
            const std::vector<double> &values = points.points()[k].values;
            const Tensor<2, dim>      &M      = of_points[k];
            for (unsigned int i = 0; i < dim; ++i)
              for (unsigned int j = 0; j < dim; ++j)
                {
                  columns[i * dim + j] = values;
                  for (double &value : columns[i * dim + j])
                    value *= M[i][j];
                }
            add_products(values, columns, matrix);
          }
        add(group, matrix);
      }
    for (unsigned int link = 0; link < links_.size(); ++link)
      if (!of_links[link].empty())
        add_link(link, of_links[link], add);
  }


  template void
  ContactPairs<2>::add_tangent(const std::vector<double> &,
                               const AddBlock &) const;
  template void
  ContactPairs<3>::add_tangent(const std::vector<double> &,
                               const AddBlock &) const;
} // namespace Morula
