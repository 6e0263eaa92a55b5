#include "app/model_file/shared_fields.hpp"

#include <cmath>

namespace drev::app {

namespace {

/// Harmonics as columns.
struct HarmonicColumns {
  std::vector<double> order, amplitude, phase;
  explicit HarmonicColumns(const std::vector<Harmonic>& harmonics) {
    for (const Harmonic& h : harmonics)
      order.push_back(h.order), amplitude.push_back(h.amplitude), phase.push_back(h.phase);
  }
  std::vector<Harmonic> all() const {
    std::vector<Harmonic> harmonics;
    for (std::size_t i = 0; i < order.size() && i < amplitude.size() && i < phase.size(); ++i)
      harmonics.push_back({order[i], amplitude[i], phase[i]});
    return harmonics;
  }
};

void drop_closing_point(std::vector<double>& arguments, std::vector<double>& values, double period) {
  if (arguments.size() < 3 || arguments.size() != values.size()) return;
  const bool closes = std::abs(arguments.back() - arguments.front() - period) <= 1e-12 * period;
  if (closes && values.back() == values.front()) arguments.pop_back(), values.pop_back();
}

}  // namespace

bool list_harmonics(Fields& f, const char* name, const Quantity& order, const Quantity& amplitude,
                    std::vector<Harmonic>& harmonics) {
  if (!f.reading() && harmonics.empty()) return false;
  HarmonicColumns c(harmonics);
  const bool given = f.columns(name, {{order, &c.order},
                                      {amplitude, &c.amplitude},
                                      {Quantity("phase", Dimension::angle), &c.phase, Need::optional}});
  if (given) harmonics = c.all();
  return given;
}

void list_interpolation(Fields& f, Interpolation& interpolation) {
  int word = static_cast<int>(interpolation);
  f.choice("interpolation", {"linear", "cubic"}, word);
  interpolation = static_cast<Interpolation>(word);
}

bool list_periodic(Fields& f, const char* name, const Quantity& argument, const Quantity& value,
                   double period, PeriodicTable& table) {
  std::vector<double> arguments = table.arguments(), values = table.values();
  if (!f.columns(name, {{argument, &arguments}, {value, &values}})) return false;
  drop_closing_point(arguments, values, period);
  table = PeriodicTable(std::move(arguments), std::move(values), period);
  return true;
}

}  // namespace drev::app
