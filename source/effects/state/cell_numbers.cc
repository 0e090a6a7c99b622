// SPDX-License-Identifier: GPL-3.0-or-later
// Copyright (C) 2026 by the Morula authors

#include <morula/base/expression_key.h>
#include <morula/base/name_list.h>
#include <morula/effects/fate/random.h>
#include <morula/effects/scene_keys.h>

#include <boost/algorithm/string.hpp>
#include <boost/container/small_vector.hpp>

#include <deque>

namespace Morula
{
  namespace
  {
    /** Section "Cell numbers/NAME". */
    struct CellNumberKeys : public Keys
    {
      explicit CellNumberKeys(const std::string &name)
        : name(name)
      {
        place_in(list(), "Cell numbers/" + name);
        split_noise.needs({at_division.path() + "=split with noise"});
      }

      std::string   name;
      ExpressionKey initial{
        {this, "Initial"},
        "0",
        "The number of a founder, and of a daughter with At division = new: an "
        "expression of the cell's state, of fields and of the numbers named "
        "before it.",
        Evaluated::event};

      ExpressionKey rate{
        {this, "Rate"},
        "0",
        "What is added to it per day: an expression of the cell's state, which "
        "may read all numbers, and by around_NAME their means over the "
        "neighbours. Of the dead as of the living. In the number's unit per "
        "day.",
        Evaluated::step};

      Key<std::string> at_division{
        {this, "At division"},
        "copied",
        "What a daughter gets at the moment of the division: copied: her "
        "mother's number; halved: half of it; split with noise: a share of it "
        "that is drawn for each division, her sister gets the rest; new: "
        "Initial, in her own state.",
        {"copied|halved|new|split with noise"}};

      Key<double> split_noise{
        {this, "Split noise"},
        0.1,
        "Standard deviation of the share that a daughter gets by split with "
        "noise: it is normally distributed around a half, and cut off at 0 and "
        "1.",
        {},
        {[](const double s) { return s >= 0. && s <= 0.5; },
         "a number from 0 to 0.5",
         "0 gives each daughter a half."}};

      Key<std::vector<double>> clamp{
        {this, "Clamp"},
        {},
        "Least and largest value, separated by a comma; empty: any.",
        {0, 2},
        {[](const std::vector<double> &ends) {
           return ends.empty() || (ends.size() == 2 && ends[0] < ends[1]);
         },
         "two numbers, the smaller one first, or nothing",
         "E.g. 0, 2."}};
    };


    /** Section "Cell numbers": names first, then a section for each of them. */
    struct CellNumbersParameters : public EffectKeys
    {
      Key<std::string> names{
        {this, "Cell numbers/Names"},
        "",
        "Numbers that each cell has of its own, separated by commas: what it "
        "has of a protein, a dose, a memory. Each has a section of this name, "
        "and expressions of cells may read it. Empty: there are none."};
      std::deque<CellNumberKeys> numbers;

      bool
      is_on() const override
      {
        return !numbers.empty();
      }

      EffectFacts
      facts() const override
      {
        EffectFacts facts;
        facts.names_key = &names;
        facts.numbers   = names_of(numbers);
        return facts;
      }

      void
      declare_sections(const std::string &text,
                       const std::vector<std::string> &) override
      {
        // What else a name may not be is known when all keys have their values.
        for (const std::string &name :
             declared_names(names, text, reason_against_column))
          numbers.emplace_back(name);
      }

      void
      check(const SceneKeys &scene, Review &) const override
      {
        // Initial is evaluated where neither later numbers nor neighbours are
        // known, nor the clock.
        const std::vector<std::string> own = scene.own_variables();
        for (const CellNumberKeys &keys : numbers)
          {
            keys.check_each(scene.dimension);
            const unsigned int place =
              std::find(own.begin(), own.end(), keys.name) - own.begin();
            for (const Variable v :
                 keys.initial.expression(scene.dimension).used())
              if (v == Variable::cycle_phase ||
                  (is_field(v) && field_number(v) >= place))
                keys.initial.refuse(
                  "an expression without the cell's phase, what is around it, "
                  "and numbers that are not named before this one",
                  "They are not known when it is evaluated: change " +
                    names.path() + ", or do without.");
          }
      }

      using Keys::list;
      KeyList
      list() override
      {
        return keys_of_all(names, numbers);
      }

    private:
      static std::string
      reason_against_column(const std::string &name)
      {
        const CellColumns<3> columns;
        for (const Columns::Entry &column : columns.entries())
          if (column.name == name)
            return "Cells have a column of this name: choose another one.";
        return name == boost::to_lower_copy(name) ?
                 reason_against_variable(name) :
                 "Columns of tables have small letters.";
      }
    };


    /**
     * Numbers of cells that change at rates of their own, by Heun's method, and
     * are passed on at divisions: doc/theory.md, section 6.12.
     */
    template <int dim>
    class CellNumbers : public Trait<dim>
    {
    public:
      using Parameters = CellNumbersParameters;

      CellNumbers(const Parameters         &parameters,
                  const EffectSetting<dim> &setting)
        : random_seed(setting.random_seed)
      {
        for (const CellNumberKeys &keys : parameters.numbers)
          {
            Number number{keys,
                          setting.state.use(keys.initial),
                          setting.state.use(keys.rate),
                          setting.columns.template add<double>(
                            {keys.name,
                             "",
                             "the cell's number of this name",
                             0.,
                             AtDivision::copied,
                             true}),
                          {}};
            if (!number.rate.is_always(0.))
              number.slope = setting.columns.template add<double>(
                {keys.name + "_slope",
                 "1/day",
                 "rate that the last step expected at its end"});
            changes = changes || number.slope.exists();
            numbers.push_back(number);
          }
      }

      void
      begin(const PresentCell<dim>      &founder,
            const CellView<dim, double> &row) const override
      {
        for (const Number &number : numbers)
          row.set(number.value,
                  number.clamped(founder.value(number.initial, 0.)));
      }

      void
      advance(const PresentCell<dim>      &before,
              const CellView<dim, double> &after,
              const double                 t0,
              const double                 t1) const override
      {
        // What was expected of the rate at the end of the last step is replaced
        // by what it has become, doc/theory.md (6.12b): fields, neighbours and
        // stress of t0 are known only now.
        if (!changes)
          return;
        Row row(before.cell().row().begin(), before.cell().row().end());
        const PastStep &past = before.reader().past;
        if (past.exists())
          for (const Number &number : numbers)
            if (number.slope.exists())
              number.add(0.5 * past.length() *
                           (before.value(number.rate, t0) -
                            before.cell().get(number.slope)),
                         view(row, before));
        integrate(before, row, after, t0, t1);
      }

      void
      born(const PresentCell<dim>      &daughter,
           const CellView<dim, double> &row,
           const std::uint64_t          mother,
           const unsigned int           which,
           const double                 birth,
           const double                 t1) const override
      {
        // The mother's numbers are those of the end of the step: they go back
        // to the moment of the division, where the rules hold, and the
        // daughter's go on from there at her own rates.
        for (const Number &number : numbers)
          {
            if (number.slope.exists())
              number.add((birth - t1) * row.get(number.slope), row);
            const double whole = row.get(number.value);
            double       part  = whole;
            if (number.at_division == "halved")
              part = 0.5 * whole;
            else if (number.at_division == "split with noise")
              {
                const double share =
                  std::clamp(0.5 +
                               number.split_noise *
                                 Random::normal_of("split of " + number.name,
                                                   random_seed,
                                                   mother),
                             0.,
                             1.);
                part = which == 0 ? share * whole : whole - share * whole;
              }
            else if (number.at_division == "new")
              part = PresentCell<dim>(row,
                                      daughter.id(),
                                      daughter.position(),
                                      daughter.reader())
                       .value(number.initial, birth);
            row.set(number.value, number.clamped(part));
          }
        if (!changes)
          return;
        Row copy(row.row().begin(), row.row().end());
        integrate(daughter, copy, row, birth, t1);
      }

      void
      declare(Tables<dim> &tables) const override
      {
        for (const Number &number : numbers)
          tables.add_mean(number.name + "_mean",
                          [value = number.value](const PresentCell<dim> &cell) {
                            return cell.cell().get(value);
                          });
      }

    private:
      using Row = boost::container::small_vector<double, 128>;

      struct Number
      {
        Number(const CellNumberKeys &keys,
               const Expression     &initial,
               const Expression     &rate,
               const Column<double> &value,
               const Column<double> &slope)
          : name(keys.name)
          , at_division(keys.at_division)
          , split_noise(keys.split_noise)
          , clamp(keys.clamp)
          , initial(initial)
          , rate(rate)
          , value(value)
          , slope(slope)
        {}

        double
        clamped(const double number) const
        {
          return clamp.empty() ? number :
                                 std::clamp(number, clamp[0], clamp[1]);
        }

        /** Adds to the value in a row. */
        void
        add(const double change, const CellView<dim, double> &row) const
        {
          row.set(value, clamped(row.get(value) + change));
        }

        std::string         name, at_division;
        double              split_noise;
        std::vector<double> clamp;
        Expression          initial, rate;
        Column<double>      value;
        /** The rate that a step expects at its end, where all but the numbers
         *  stay; does not exist for numbers that do not change. */
        Column<double> slope;
      };

      static CellView<dim, double>
      view(Row &row, const PresentCell<dim> &cell)
      {
        return {ArrayView<double>(row.data(), row.size()),
                cell.cell().columns()};
      }

      /**
       * Takes the numbers in @p row from t0 to t1 (day) and writes them to
       * @p after. All else of the cell stays as @p row has it.
       * @param cell that the row is of
       */
      void
      integrate(const PresentCell<dim>      &cell,
                Row                         &row,
                const CellView<dim, double> &after,
                const double                 t0,
                const double                 t1) const
      {
        // Heun's method, doc/theory.md (6.12a). All rates of a moment are
        // evaluated before a number changes.
        const CellView<dim, double> state  = view(row, cell);
        const auto                  slopes = [&](const double t) {
          const PresentCell<dim>                     present(state,
                                         cell.id(),
                                         cell.position(),
                                         cell.reader());
          boost::container::small_vector<double, 16> list;
          for (const Number &number : numbers)
            list.push_back(
              number.slope.exists() ? present.value(number.rate, t) : 0.);
          return list;
        };
        const auto at_t0 = slopes(t0);
        for (std::size_t k = 0; k < numbers.size(); ++k)
          {
            after.set(numbers[k].value, state.get(numbers[k].value));
            numbers[k].add((t1 - t0) * at_t0[k], state);
          }
        const auto at_t1 = slopes(t1);
        for (std::size_t k = 0; k < numbers.size(); ++k)
          if (numbers[k].slope.exists())
            {
              numbers[k].add(0.5 * (t1 - t0) * (at_t0[k] + at_t1[k]), after);
              after.set(numbers[k].slope, at_t1[k]);
            }
      }

      std::uint64_t       random_seed;
      std::vector<Number> numbers;
      bool                changes = false;
    };
  } // namespace


  void
  add_cell_numbers(Catalogue &catalogue)
  {
    catalogue.add_own<CellNumbers>(
      "cell numbers",
      {"Cell numbers/Names=dose, memory",
       "Cell numbers/dose/Initial=1 + 0.1*X*Y",
       "Cell numbers/dose/Rate=J_e - dose + 0.5*around_dose",
       "Cell numbers/dose/At division=split with noise",
       "Cell numbers/memory/Initial=dose + noise",
       "Cell numbers/memory/Rate=dose",
       "Cell numbers/memory/At division=new",
       "Cell numbers/memory/Clamp=0, 3",
       "Growth/Law=rate",
       "Growth/Rate/Rate=dose",
       "Division by size/Volume=1.1",
       "Proliferation/Cell cycle/Division axis=random",
       "Proliferation/Cell cycle/Least anisotropy=1"});
  }
} // namespace Morula
