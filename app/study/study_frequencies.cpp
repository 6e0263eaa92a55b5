// Tables 5.1 to 5.4, figures 5.5 to 5.8 and A.1 to A.8: modes of the free camshaft.
#include <drev/solvers/modes/modes.hpp>

#include <algorithm>
#include <cmath>

#include "app/base/text_layout.hpp"
#include "app/chart/svg_chart.hpp"
#include "app/study/study_runs.hpp"
#include "models/camshaft/published.hpp"

namespace drev::app {

namespace {

constexpr int kModes = 5, kShapes = 4;

struct Differences {
  double squares = 0.0, worst = 0.0;
  int count = 0;
  void add(double ours, double theirs) {
    const double d = std::abs(ours / theirs - 1.0);
    squares += d * d, worst = std::max(worst, d), ++count;
  }
  std::string text() const {
    return digits(100.0 * std::sqrt(squares / count), 2) + " % rms, at most " + digits(100.0 * worst, 2) +
           " %";
  }
};

int sign_changes(const Eigen::VectorXd& shape) {
  int changes = 0;
  for (Eigen::Index i = 1; i < shape.size(); ++i) changes += shape[i] * shape[i - 1] < 0.0 ? 1 : 0;
  return changes;
}

StudyPicture shapes_picture(const ModeSet& modes, int cylinders) {
  std::vector<ChartSeries> series;
  for (int m = 0; m < kShapes; ++m) {
    ChartSeries line{.name = "mode " + std::to_string(m + 1) + ", " +
                             digits(modes.frequency_Hz[static_cast<std::size_t>(m)], 4) + " Hz"};
    const Eigen::VectorXd shape = modes.shapes.col(m);
    for (Eigen::Index i = 0; i < shape.size(); ++i) {
      line.x.push_back(static_cast<double>(i));
      line.y.push_back(shape[i] / shape[shape.size() - 1]);
    }
    series.push_back(std::move(line));
  }
  const std::string n = std::to_string(cylinders);
  return {"modes_" + n, "Modes of the free camshaft of " + n + " cylinders, the free end at 1",
          svg_chart({.title = "Free camshaft, " + n + " cylinders",
                     .x_label = "station from the gear",
                     .y_label = "angle over that of the free end"},
                    series)};
}

}  // namespace

StudyGroup study_frequencies() {
  StudyGroup group{.title = "Frequencies of the free camshaft"};
  group.how =
      "Undamped torsional modes, rigid-body mode left out. Published: the source's multibody "
      "model; its finite "
      "elements in the notes. An eigenvalue has no time step.";
  Differences to_mbs, to_fem;
  std::vector<double> first;
  bool shapes_right = true;
  StudyTable table{"First five modes"};
  for (int cylinders = 6; cylinders <= 10; ++cylinders) {
    const ModelCase model_case =
        build_case("camshaft", {{"cylinders", std::to_string(cylinders)}, {"drive", "free"}});
    const ModeSet modes = solve_modes(model_case.model.build(), {.count = kModes});
    first.push_back(modes.frequency_Hz[0]);
    const auto* printed = std::find_if(published::kFreeModes.begin(), published::kFreeModes.end(),
                                       [&](const auto& p) { return p.cylinders == cylinders; });
    for (int m = 0; m < kModes; ++m) {
      const auto at = static_cast<std::size_t>(m);
      const double f = modes.frequency_Hz[at];
      StudyRow row{"-",          std::to_string(cylinders) + " cylinders, mode " + std::to_string(m + 1),
                   "Hz",         "-",
                   "-",          Estimate{f, kModeError * f, Estimate::Kind::measured},
                   "not printed"};
      if (printed != published::kFreeModes.end()) {
        double mbs = printed->mbs[at], fem = printed->fem[at];
        const bool swapped = cylinders == 9 && m == 4;
        if (swapped) std::swap(mbs, fem);
        to_mbs.add(f, mbs);
        to_fem.add(f, fem);
        row.source = std::string("Table ") + printed->table;
        row.published = digits(printed->mbs[at], printed->mbs[at] < 1000.0 ? 5 : 6);
        row.note = std::string(swapped ? "printed values swapped, compared in their right places; " : "") +
                   "drev to multibody " + percent(f, mbs) + ", to finite elements (" + digits(fem, 5) + ") " +
                   percent(f, fem);
      }
      table.rows.push_back(std::move(row));
      shapes_right = shapes_right && sign_changes(modes.shapes.col(m)) == m + 1;
    }
    if (cylinders == 6 || cylinders == 8 || cylinders == 9)
      group.pictures.push_back(shapes_picture(modes, cylinders));
  }
  group.tables = {std::move(table)};
  group.verdicts = {
      "The reconstruction has the multibody frequencies to " + to_mbs.text() +
          ", the finite-element ones to " + to_fem.text() +
          ". Frequencies fall with the number of cylinders, from " + digits(first.front(), 4) + " to " +
          digits(first.back(), 4) + " Hz: **that conclusion " +
          stands(std::is_sorted(first.rbegin(), first.rend())) + "**.",
      std::string("Figures 5.5 to 5.8 and A.1 to A.8: mode m changes its sign ") +
          (shapes_right ? "m times along the shaft, for 6 to 10 cylinders, as a shaft's modes must."
                        : "otherwise than m times for some shaft.")};
  return group;
}

}  // namespace drev::app
