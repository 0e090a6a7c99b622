// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#ifndef morula_effects_fate_random_h
#define morula_effects_fate_random_h

#include <deal.II/base/tensor.h>

#include <array>
#include <cstdint>
#include <string>

/**
 * Random numbers as pure functions of (seed, lineage key, draw), from the
 * counter-based generator Philox 4x32-10 of Random123: no state to save, and
 * the same for any number of ranks and any order of evaluation.
 */
namespace Morula::Random
{
  /** 128 random bits. Philox key: the two halves of @p key; counter: those of
   *  @p a and @p b. */
  std::array<std::uint64_t, 2>
  bits(const std::uint64_t key, const std::uint64_t a, const std::uint64_t b);

  /** The upper 53 bits as (k + 1) 2^-53, k = 0...2^53 - 1: in (0, 1]. */
  double
  uniform(const std::uint64_t random_bits);

  /** Key of founder number @p id. */
  std::uint64_t
  founder_key(const std::uint64_t seed, const std::uint64_t id);

  /** Key of a daughter: from its mother's key and which of the two it is, 0 or
   *  1. */
  std::uint64_t
  daughter_key(const std::uint64_t seed,
               const std::uint64_t mother_key,
               const unsigned int  which);

  /** Exponentially distributed with @p rate (1/day); infinite for rate 0. */
  double
  exponential(const std::uint64_t seed,
              const std::uint64_t key,
              const double        rate);

  /** The threshold of the hazard of transition number @p which out of the
   *  cell's type, after @p n_changes of type: exponentially distributed with
   *  mean 1. */
  double
  transition_threshold(const std::uint64_t seed,
                       const std::uint64_t key,
                       const unsigned int  n_changes,
                       const unsigned int  which);

  /** The threshold at which the hazard of death ends the cell's life:
   *  exponentially distributed with mean 1. */
  double
  death_threshold(const std::uint64_t seed, const std::uint64_t key);

  /** The threshold at which hazard number @p n of an effect of this name brings
   *  its event: exponentially distributed with mean 1. Draws of other names and
   *  numbers are independent of it. */
  double
  threshold_of(const std::string  &name,
               const std::uint64_t seed,
               const std::uint64_t key,
               const unsigned int  n = 0);

  /** Normally distributed, of mean 0 and deviation 1; drawn as
   *  threshold_of() is, from which it follows. */
  double
  normal_of(const std::string  &name,
            const std::uint64_t seed,
            const std::uint64_t key);

  /** Uniform in (0, 1), the cell's own. */
  double
  noise(const std::uint64_t seed, const std::uint64_t key);

  /** Uniform in [0, 1): the part of its phase that a founder, whose phase is
   *  given, has behind it. */
  double
  part_of_phase(const std::uint64_t seed, const std::uint64_t key);

  /** Key for the axis of a cycle that began before t = 0. It is not the
   *  founder's own key, which draws the axis of its next cycle. */
  std::uint64_t
  past_key(const std::uint64_t seed, const std::uint64_t founder_key);

  /** Uniform on the unit sphere (2-D: circle). */
  template <int dim>
  dealii::Tensor<1, dim>
  direction(const std::uint64_t seed, const std::uint64_t key);

  /**
   * A von Mises-Fisher distribution around a direction, with the density
   * C exp(κ n·axis) on the unit sphere (2-D: circle), doc/theory.md (6.3d).
   * @param axis          unit vector
   * @param concentration κ > 0: the larger, the nearer to the axis; the mean
   *        square angle tends to (dim - 1)/κ
   */
  template <int dim>
  dealii::Tensor<1, dim>
  direction_around(const dealii::Tensor<1, dim> &axis,
                   const double                  concentration,
                   const std::uint64_t           seed,
                   const std::uint64_t           key);
} // namespace Morula::Random

#endif
