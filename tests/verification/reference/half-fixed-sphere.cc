// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

// An independent reference for the half-fixed sphere (Fig. 2 of Yokoyama et
// al. 2023): a sphere of tissue grows by the same stretch theta everywhere,
//   F = F_e theta I,
// while the lower half of its surface keeps its place and the upper half is
// free. The problem is axisymmetric, so the meridian half disc is meshed, with
// grid cells that follow the surface and become smaller and smaller toward the
// edge of the held surface, where the solution is singular. Nothing here comes
// from Morula's library; only deal.II is used.
//
// The program in the order in which it is best read:
//   half-fixed-sphere/parameters.h       what can be chosen
//   half-fixed-sphere/mesh.h             the graded half disc
//   half-fixed-sphere/neo_hookean.h      energy, stress, tangent at a point
//   half-fixed-sphere/meridian_values.h  F of an axisymmetric field
//   half-fixed-sphere/equilibrium.h      assembly, Newton's method, growth
//   half-fixed-sphere/stability.h        waves around the axis
//   half-fixed-sphere/results.h          integrals, outline, files
// Results and their errors: doc/half-fixed-sphere.md.

#include <half-fixed-sphere/equilibrium.h>
#include <half-fixed-sphere/results.h>

#include <iostream>

namespace
{
  using namespace HalfFixedSphere;

  const std::string usage =
    "half-fixed-sphere [-s \"Key=value\"]... [--check-tangent] [--parameters]\n"
    "                  [--help]\n\n"
    "Grows a sphere whose lower half surface is held, by axisymmetric finite\n"
    "elements, and writes apex, volume, mean energy and outline.\n\n"
    "  -s KEY=VALUE     override one key; may be repeated\n"
    "  --check-tangent  compare residual and tangent with differences in the\n"
    "                   last state\n"
    "  --parameters     print every key with default and meaning\n"
    "  --help           print this text\n";


  struct CommandLine
  {
    CommandLine(const std::vector<std::string> &words)
    {
      for (unsigned int i = 0; i < words.size(); ++i)
        if (words[i] == "-s" && i + 1 < words.size())
          overrides.push_back(words[++i]);
        else if (words[i] == "--check-tangent")
          check_tangent = true;
        else if (words[i] == "--parameters")
          print_parameters = true;
        else if (words[i] == "--help")
          print_help = true;
        else
          throw InputError("command line",
                           words[i],
                           "there is no such option; --help prints them");
    }

    std::vector<std::string> overrides;
    bool                     check_tangent    = false;
    bool                     print_parameters = false;
    bool                     print_help       = false;
  };


  void
  grow(const Parameters &parameters, const bool check_tangent)
  {
    Triangulation<2> mesh;
    make_half_disc(parameters.radius, parameters.edge, parameters.mesh, mesh);
    Equilibrium body(mesh, parameters);
    Writer      writer(parameters);
    for (const double theta : parameters.stretches)
      {
        body.grow_to(theta);
        writer.write(body);
      }
    if (check_tangent)
      {
        const std::array<double, 2> errors = body.derivative_errors();
        std::cout << "residual against energy: " << errors[0]
                  << "\ntangent against residual: " << errors[1] << std::endl;
      }
  }


  void
  run(const CommandLine &command)
  {
    if (command.print_help)
      std::cout << usage;
    else if (command.print_parameters)
      {
        Parameters       defaults;
        ParameterHandler prm;
        defaults.declare(prm);
        prm.print_parameters(std::cout, ParameterHandler::Text);
      }
    else
      grow(Parameters::read(command.overrides), command.check_tangent);
  }


  int
  fail(const int code, const std::string &message)
  {
    std::cerr << "half-fixed-sphere: " << message << std::endl;
    return code;
  }
} // namespace


int
main(int argc, char *argv[])
{
  deal_II_exceptions::disable_abort_on_exception();
  deal_II_exceptions::suppress_stacktrace_in_exceptions();
  try
    {
      run(CommandLine(std::vector<std::string>(argv + 1, argv + argc)));
      return 0;
    }
  catch (const InputError &error)
    {
      return fail(1, error.what());
    }
  catch (const std::exception &error)
    {
      return fail(2, error.what());
    }
}
