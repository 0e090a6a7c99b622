// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/expression_parser.h>
#include <morula/base/input_error.h>
#include <morula/base/name_list.h>

#include <boost/algorithm/string.hpp>

#include <algorithm>
#include <cctype>
#include <iterator>
#include <numeric>
#include <set>
#include <utility>

namespace Morula
{
  std::vector<std::string>
  split_names(const std::string &text)
  {
    std::vector<std::string> names;
    // An empty text has no names, rather than one that is empty.
    if (boost::trim_copy(text).empty())
      return names;
    boost::split(names, text, boost::is_any_of(","));
    for (std::string &name : names)
      boost::trim(name);
    return names;
  }


  std::string
  reason_against_section(const std::string &name)
  {
    const bool plain =
      !name.empty() && std::all_of(name.begin(), name.end(), [](const char c) {
        return std::isalnum(static_cast<unsigned char>(c)) || c == '_';
      });
    return plain ? "" : "Names have letters, digits and '_'.";
  }


  std::string
  reason_against_variable(const std::string &name)
  {
    if (!reason_against_section(name).empty() ||
        !std::isalpha(static_cast<unsigned char>(name[0])))
      return "Names have letters, digits and '_', and begin with a letter.";
    if (!is_free_name(name))
      return "Expressions have a variable or function of this name: choose "
             "another one.";
    return "";
  }


  std::vector<std::string>
  declared_names(
    const AnyKey                                          &key,
    const std::string                                     &text,
    const std::function<std::string(const std::string &)> &reason_against)
  {
    // A name is refused for a reason of its own, or because it is there twice.
    const std::vector<std::string> list = split_names(text);
    std::set<std::string>          seen;
    for (const std::string &name : list)
      {
        const std::string reason = reason_against(name);
        if (!reason.empty() || !seen.insert(name).second)
          throw InputError(key.path(),
                           text,
                           "names that differ, separated by commas",
                           "'" + name + "': " +
                             (reason.empty() ? "it is there twice." : reason));
      }
    return list;
  }


  void
  place_in(const KeyList &keys, const std::string &section)
  {
    for (AnyKey *key : keys)
      key->place_in(section);
  }


  namespace
  {
    /** Characters. A longer word is no misspelt name, and its table would be
     *  large. */
    constexpr std::size_t longest_word = 200;

    /** Parts of keys' paths, and what else the field calls it. */
    const std::vector<std::pair<std::string, std::string>> synonyms = {
      {"Dimension", "2d,3d,plane strain"},
      {"Tissue/Shape", "tumour,tumor,spheroid,organoid,embryo,sheet,tube"},
      {"Cell spacing", "cell size,cell diameter,cell length,number of cells"},
      {"Grid/Spacing", "resolution,mesh size,element size,grid size"},
      {"Young's modulus",
       "stiffness,elasticity,rigidity,modulus,elastic modulus,ecm,"
       "extracellular matrix,matrix,collagen,basement membrane,basal lamina"},
      {"Poisson's ratio", "compressibility,incompressible,bulk modulus"},
      {"Relaxation time",
       "viscosity,viscous,viscoelasticity,creep,remodelling,fluidity"},
      {"Yield stress", "plasticity,plastic,yielding"},
      {"Growth/Rate",
       "growth rate,anisotropic growth,elongation,swelling,hypertrophy"},
      {"Growth/Rate/Homeosta", "mechanical feedback,mechanosensing"},
      {"Cell cycle/Duration", "cycle length,cycle time,doubling time"},
      {"G0 exit rate",
       "proliferation rate,quiescence,quiescent,senescence,growth arrest,"
       "doubling time,mechanosensing"},
      {"Size checkpoint", "contact inhibition,crowding"},
      {"Proliferation/Law", "mitosis,cytokinesis,cell division"},
      {"Division/Rate", "mitosis,cell division,doubling time"},
      {"Division by size", "mitosis,cell division,cell volume"},
      {"Division axis",
       "spindle axis,spindle,orientation,division orientation"},
      {"Daughter types", "asymmetric division,stem cell,self-renewal"},
      {"Transitions",
       "differentiation,fate decision,cell fate,mutation,senescence,ageing"},
      {"Contraction", "apical constriction,actomyosin,myosin,active stress"},
      {"Death",
       "apoptosis,necrosis,necrotic core,cell death,turnover,drug,treatment,"
       "chemotherapy,radiation"},
      {"Death/When", "wound,ablation,laser"},
      {"Tissue/Cuts", "wound,ablation,incision"},
      {"Extrusion", "delamination,shedding,sloughing"},
      {"Fields",
       "morphogen,oxygen,nutrient,nutrients,signal,concentration,hypoxia,"
       "glucose,drug,growth factor,inhibitor,activator"},
      {"Cell numbers", "protein,gene,gene expression,drug,dose,memory"},
      {"Consumption", "uptake,absorption,decay,degradation"},
      {"Production", "secretion,source"},
      {"Diffusion", "diffusivity,diffusion coefficient"},
      {"Tension/With", "adhesion,cohesion,differential adhesion,cell sorting"},
      {"Surface tension", "cortical tension,line tension"},
      {"Fusion time", "adhesion,fusion of tissues"},
      {"Rearrangement", "intercalation,migration,motility,mixing,invasion"},
      {"Rearrangement/Drive", "chemotaxis,polarity,convergent extension"},
      {"Friction", "drag,viscous drag,substrate,folding,buckling"},
      {"Obstacles", "wall,confinement,mould,substrate,gel,dish"},
      {"Contact", "collision,self-contact,self-collision,folding"},
      {"Fixed where", "clamp,clamped,anchored,dirichlet"},
      {"Slip where", "symmetry,sliding,roller"},
      {"Traction", "load,neumann,pulling force"},
      {"Boundary conditions/Pressure", "turgor,hydrostatic pressure"},
      {"Force density", "gravity,weight"},
      {"Lumen", "cavity,turgor,osmotic pressure,hydrostatic pressure"},
      {"Cell types",
       "cell type,heterogeneity,tumour,tumor,cancer,clone,mutant,layer,"
       "extracellular matrix,ecm"},
      {"Output/Interval", "frames,film,frame rate,picture,video"},
      {"Output/Formats", "clone,lineage tracing"},
      {"Output/Snapshot", "restart,checkpointing"},
      {"Random seed", "seed,random number"}};

    std::string
    last_name(const std::string &path)
    {
      return path.substr(path.rfind('/') + 1);
    }
  } // namespace


  unsigned int
  edit_distance(const std::string &a, const std::string &b)
  {
    // Three rows of the table of distances between the beginnings of both texts
    // are enough: rows i - 1, i and i + 1.
    std::vector<unsigned int> before(b.size() + 1), row(b.size() + 1),
      next(b.size() + 1);
    std::iota(row.begin(), row.end(), 0u);
    for (std::size_t i = 0; i < a.size(); ++i)
      {
        next[0] = i + 1;
        for (std::size_t j = 0; j < b.size(); ++j)
          {
            next[j + 1] = std::min(
              {row[j + 1] + 1, next[j] + 1, row[j] + (a[i] == b[j] ? 0u : 1u)});
            // Two letters that were swapped count once.
            if (i > 0 && j > 0 && a[i] == b[j - 1] && a[i - 1] == b[j])
              next[j + 1] = std::min(next[j + 1], before[j - 1] + 1);
          }
        before.swap(row);
        row.swap(next);
      }
    return row.back();
  }


  std::string
  most_similar(const std::string              &word,
               const std::vector<std::string> &candidates)
  {
    std::string best;
    if (word.size() > longest_word)
      return best;
    // At most a third of the letters may differ, at least one, but never all.
    unsigned int limit = std::max<std::size_t>(1, word.size() / 3) + 1;
    for (const std::string &candidate : candidates)
      {
        const unsigned int distance =
          edit_distance(boost::to_lower_copy(word),
                        boost::to_lower_copy(candidate));
        if (distance < limit && distance < candidate.size())
          {
            limit = distance;
            best  = candidate;
          }
      }
    return best;
  }


  std::vector<std::string>
  words_of_keys(const std::string &name)
  {
    std::vector<std::string> result;
    for (const auto &[word, others] : synonyms)
      {
        const std::vector<std::string> list = split_names(others);
        if (std::find(list.begin(), list.end(), boost::to_lower_copy(name)) !=
            list.end())
          result.push_back(word);
      }
    return result;
  }


  std::string
  similar_word(const std::string &word)
  {
    std::vector<std::string> known;
    for (const auto &[key, others] : synonyms)
      {
        known.push_back(last_name(key));
        for (const std::string &other : split_names(others))
          known.push_back(other);
      }
    return most_similar(word, known);
  }


  std::string
  suggest_path(const std::string              &wanted,
               const std::vector<std::string> &candidates)
  {
    // First comes a path that is spelt nearly so and ends with the same name.
    // Then the same name in any other section, of which there may be several.
    // Then a path that is spelt nearly so at all.
    const std::string        best = most_similar(wanted, candidates);
    std::vector<std::string> found;
    if (boost::iequals(last_name(best), last_name(wanted)))
      found = {best};
    else
      std::copy_if(candidates.begin(),
                   candidates.end(),
                   std::back_inserter(found),
                   [&](const std::string &candidate) {
                     return boost::iequals(last_name(candidate),
                                           last_name(wanted));
                   });
    if (found.empty() && !best.empty())
      found = {best};
    return found.empty() ?
             "" :
             "Did you mean '" + boost::join(found, "' or '") + "'?";
  }
} // namespace Morula
