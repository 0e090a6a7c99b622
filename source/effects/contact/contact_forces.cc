// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/send_records.h>
#include <morula/effects/contact/contact_forces.h>

#include <map>

namespace Morula
{
  template <int dim>
  std::vector<ForceBetween<dim>>
  contact_forces(const ContactPoints<dim>             &points,
                 const std::vector<ForceBetween<dim>> &of_pairs,
                 const MPI_Comm                        comm)
  {
    // A rank knows the forces of its pairs, also on points of other ranks. They
    // go to the owners of the points, which add up what comes from several
    // ranks in the order of these.
    std::map<unsigned int, std::vector<ForceBetween<dim>>> by_owner;
    for (const ForceBetween<dim> &one : of_pairs)
      {
        const ContactPoint<dim> &point = points.points()[one.p];
        by_owner[point.owner].push_back(one);
        by_owner[point.owner].back().p = point.p;
      }
    std::map<std::pair<unsigned int, unsigned int>, ForceBetween<dim>> sums;
    for (const auto &[rank, list] : send_records(by_owner, comm))
      for (const ForceBetween<dim> &one : list)
        {
          const auto [sum, is_new] =
            sums.emplace(std::make_pair(one.p, one.other), one);
          if (!is_new)
            {
              sum->second.force += one.force;
              sum->second.touches |= one.touches;
            }
        }
    std::vector<ForceBetween<dim>> result;
    for (const auto &[key, sum] : sums)
      result.push_back(sum);
    return result;
  }


#define INSTANTIATE(dim)                                  \
  template std::vector<ForceBetween<dim>> contact_forces( \
    const ContactPoints<dim> &,                           \
    const std::vector<ForceBetween<dim>> &,               \
    const MPI_Comm);
  INSTANTIATE(2)
  INSTANTIATE(3)
#undef INSTANTIATE
} // namespace Morula
