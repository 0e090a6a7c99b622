// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/instantiate.h>
#include <morula/base/near_tree.h>
#include <morula/base/step_failed.h>
#include <morula/effects/contact/contact_pairs.h>
#include <morula/effects/interaction.h>
#include <morula/particles/nearest.h>

#include <deal.II/base/mpi.h>
#include <deal.II/base/symmetric_tensor.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <sstream>
#include <string>
#include <vector>

namespace Morula
{
  namespace
  {
    /** Tangential forces of the drag, and forces of new pairs, that are left
     *  after the last turn, in units of the normal forces. Facets of two
     *  surfaces that slide add about as much to the former. */
    constexpr double small_drag = 0.005, small_part = 0.01;

    /** The geometry follows a smaller part of the way, down to the least, after
     *  turns in which more than this part of the tangential forces has stayed.
     */
    constexpr double staying = 0.8, smallest_part = 0.25;

    /** Where more than this part has stayed, and at least this part of it goes
     *  on in one direction, the drag holds back a long slide. It gets so much
     * of its strength then, down to the least. */
    constexpr double slow = 0.5, one_way = 0.5, softer = 0.25,
                     least_drag = 1. / 256.;

    /** Forces below this count as none, in units of E h^(dim-1). */
    constexpr double no_force = 1e-9;

    /** How deep points may be in another body that were no candidates for its
     *  contact, in units of h: rounding. */
    constexpr double no_depth = 1e-3;


    /**
     * The contact in an attempt at a step: its pairs hold positions, normals
     * and areas fixed in a turn, and take them anew after it. Keeps references
     * to all that it is given.
     */
    template <int dim>
    class ContactInStep : public InteractionInStep<dim>
    {
    public:
      ContactInStep(const AttemptAtStep<dim> &attempt,
                    const ContactPoints<dim> &points,
                    const ContactLaw         &law,
                    bool                     &keeps_drag)
        : attempt(attempt)
        , points(points)
        , law(law)
        , pairs_(points, law)
        , keeps_drag(keeps_drag)
      {}

      PairTerm &
      pairs() override
      {
        return pairs_;
      }

      /** A weak drag acts from where the cells are in each turn. */
      void
      take_drag(Drag<dim> &of_step, const bool is_weak) override
      {
        drag      = &of_step;
        recentres = is_weak;
      }

      void
      begin(MomentumBalance<dim> &of_step, const Equilibrium::Vector &) override
      {
        balance = &of_step;
      }

      /** @throws StepFailed where bodies pass through each other, or slide by
       *          more than a grid spacing */
      bool
      renew(const Equilibrium::Vector &u) override
      {
        // All ranks get the sums and extremes of all pairs, so that they decide
        // alike. Where the equilibrium is good enough, the frozen geometry
        // stays: forces are read from the state that was solved for. Otherwise
        // the pairs take their new geometry, and the weak drag a new centre.
        const TimerOutput::Scope section(attempt.timer, "contact");
        const auto renewal = pairs_.look(balance->relevant_values(u));
        double     sums[5] = {renewal.normal,
                              renewal.tangential,
                              renewal.of_new_pairs,
                              1. * renewal.has_new_links,
                              renewal.onward};
        Utilities::MPI::sum(sums, attempt.comm, sums);
        const double crossed =
                       Utilities::MPI::max(renewal.crossed, attempt.comm),
                     slid = Utilities::MPI::max(renewal.slid, attempt.comm);
        const DisplacementField<dim> displacement(attempt.space,
                                                  u,
                                                  attempt.comm);
        std::ostringstream           text;
        if (crossed > 0.)
          text << "two bodies overlap by " << crossed
               << " um, so that the step is too long for their contact";
        else if (slid > points.way())
          {
            keeps_drag = keeps_drag || drag_part < 1.;
            text << "bodies in contact slide by " << slid
                 << " um along each other, more than " << points.way()
                 << " um: the step is too long for their contact";
          }
        else if (has_crossed_from_afar(
                   attempt.tissue, points, displacement, law.h))
          text
            << "bodies pass through each other, so that the step is too long "
               "for their contact";
        if (!text.str().empty())
          throw StepFailed(text.str());

        const double unit = law.E * std::pow(law.h, dim - 1);
        if (sums[1] <= small_drag * sums[0] + no_force * unit &&
            sums[2] <= small_part * sums[0] + no_force * unit)
          return false;
        // A soft body slides far against the drag, a little in each turn, if
        // all of it goes one way: the drag becomes weaker then. A curved body
        // may slide off along its frozen normals then: in the attempts that
        // follow the drag stays as it is. Where a surface is strongly curved
        // the geometry may swing between two states for ever. So it follows
        // only a part of the way, half as much each time that less than a fifth
        // of the tangential forces has gone.
        const bool slides_far = !keeps_drag && sums[1] > slow * left_over &&
                                sums[4] > one_way * sums[1] &&
                                drag_part > least_drag;
        const double before = left_over;
        left_over           = sums[1];
        if (slides_far)
          {
            drag_part *= softer;
            left_over *= softer;
            pairs_.set_drag(drag_part);
          }
        else if (sums[1] > staying * before)
          part = std::max(0.5 * part, smallest_part);
        const std::vector<double> values = balance->relevant_values(u);
        frozen.resize(values.size(), 0.);
        for (std::size_t i = 0; i < values.size(); ++i)
          frozen[i] += part * (values[i] - frozen[i]);
        if (part < 1. || slides_far)
          sums[3] = pairs_.look(frozen).has_new_links;
        pairs_.adopt();
        if (Utilities::MPI::max(sums[3], attempt.comm) > 0.)
          balance->renew_links();
        if (recentres)
          drag->set_centre(displacement.values_at(attempt.tissue.cells()));
        return true;
      }

      std::string
      unfinished() const override
      {
        return "the contact of two bodies is still changing after twenty "
               "repeated solves";
      }

      std::vector<ForceBetween<dim>>
      forces(const Equilibrium::Vector &u) const override
      {
        return contact_forces(points,
                              pairs_.forces(balance->relevant_values(u)),
                              attempt.comm);
      }

    private:
      const AttemptAtStep<dim> &attempt;
      const ContactPoints<dim> &points;
      const ContactLaw          law;
      ContactPairs<dim>         pairs_;
      bool                     &keeps_drag; // at its strength, in all turns
      Drag<dim>                *drag      = nullptr;
      MomentumBalance<dim>     *balance   = nullptr;
      bool                      recentres = false; // the drag
      /** The relevant unknowns at which the geometry is frozen; empty at t. */
      std::vector<double> frozen;
      double              part = 1.; // of the way that the geometry follows
      double              drag_part = 1.; // of the pairs' drag
      double              left_over = std::numeric_limits<double>::max();
    };
  } // namespace


  template <int dim>
  bool
  has_crossed_from_afar(const Tissue<dim>            &tissue,
                        const ContactPoints<dim>     &points,
                        const DisplacementField<dim> &displacement,
                        const double                  h)
  {
    // Two points that could not meet within the reach of the candidates can if
    // both move further. Each boundary point tells where the step brings it. A
    // point that faces another one of another body, near along the surface, has
    // crossed it if it is behind it now but was before it at t. Candidates at t
    // are left out, as the energy and its limits are for them.
    const BoundaryPoints<dim>        &store = tissue.boundary_points();
    const std::vector<Tensor<1, dim>> ways  = displacement.values_at(store);

    double longest = 0.;
    for (const Tensor<1, dim> &way : ways)
      longest = std::max(longest, way.norm());
    longest = Utilities::MPI::max(longest, tissue.communicator());
    if (2. * longest <= points.way())
      return false;
    const double known =
      points.way() + ContactPoints<dim>::kernel * points.largest_spacing();
    const double reach =
      2. * longest + ContactPoints<dim>::kernel * points.largest_spacing();
    const auto numbers = [&](const unsigned int p, std::vector<double> &list) {
      append_flat(list, store.area_vector(p));
      append_flat(list, ways[p]);
      list.push_back(store.body(p));
    };
    const PointList<dim> near =
      near_points(store.positions(),
                  store,
                  {2 * dim + 1, numbers, Ties::lowest_id},
                  tissue.grid(),
                  static_cast<int>(std::ceil(reach / h)));
    const NearTree<dim> tree(near.positions);
    bool                crossed = false;
    for (unsigned int p = 0; p < store.size() && !crossed; ++p)
      {
        const Point<dim>     x = store.position(p);
        const Tensor<1, dim> n =
          store.area_vector(p) / store.area_vector(p).norm();
        for (const unsigned int i : tree.within(x, reach))
          {
            const double *const row = near.row(i).data();
            if (!store.has_parts() && row[2 * dim] == store.body(p))
              continue;
            const auto           area   = Flat<Tensor<1, dim>>::read(row);
            const auto           way    = Flat<Tensor<1, dim>>::read(row + dim);
            const Tensor<1, dim> across = 0.5 * (area / area.norm() - n);
            const Tensor<1, dim> before = x - near.positions[i];
            if (n * area > Parting<dim>::facing * area.norm() ||
                before.norm() < known)
              continue;
            const Tensor<1, dim> after  = before + ways[p] - way;
            const Tensor<1, dim> normal = across / across.norm();
            const double         s = (after - (normal * after) * normal).norm();
            crossed                = crossed ||
                      (across * before > 0. && across * after < -no_depth * h &&
                       s < points.largest_spacing());
          }
      }
    return Utilities::MPI::logical_or(crossed, tissue.communicator());
  }


  template <int dim>
  std::unique_ptr<InteractionInStep<dim>>
  contact_in_step(const AttemptAtStep<dim> &attempt,
                  const ContactPoints<dim> &points,
                  const ContactLaw         &law,
                  bool                     &keeps_drag)
  {
    return std::make_unique<ContactInStep<dim>>(attempt,
                                                points,
                                                law,
                                                keeps_drag);
  }


  MORULA_INSTANTIATE(has_crossed_from_afar);
  MORULA_INSTANTIATE(contact_in_step);


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
