#include <drev/core/control/controllers.hpp>
#include <drev/core/error.hpp>
#include <drev/core/law/friction.hpp>
#include <drev/solvers/reduction/reduction.hpp>

#include <algorithm>
#include <sstream>

#include "solvers/reduction/craig_bampton.hpp"
#include "solvers/reduction/residual_vectors.hpp"

namespace drev {

namespace {

using Matrix = Eigen::MatrixXd;

void check_options(const System& system, const ReductionOptions& o) {
  std::vector<Finding> findings;
  ParameterCheck check(system.name() + "/reduction", findings);
  const bool modal = o.kind == ReductionOptions::Kind::modal;
  check.within("modes", o.modes, 0, 1e6, "");
  check.non_negative("up_to_Hz", o.up_to_Hz, "Hz");
  if ((o.modes > 0) == (o.up_to_Hz > 0.0) && (modal || o.modes > 0))
    check.fail("modes", std::to_string(o.modes), "", "or up_to_Hz must be > 0, one of them");
  if (modal && !o.keep.empty())
    check.fail("keep", std::to_string(o.keep.size()) + " nodes", "", "is for craig_bampton");
  check.within("static_accuracy", o.static_accuracy, 1e-12, 1.0, "");
  if (!findings.empty()) throw ModelError(findings);
}

std::string percent(double share) {
  std::ostringstream text;
  text.precision(2);
  text << 100.0 * share << " %";
  return text.str();
}

std::string in_Hz(double frequency) {
  std::ostringstream text;
  text.precision(4);
  text << frequency << " Hz";
  return text.str();
}

Reduction modal(const System& system, const ReductionOptions& o) {
  const int elastic = system.elastic_mode_count();
  const KeptModes kept = kept_modes(system, o.modes > 0 ? std::min(o.modes, elastic) : 0, o.up_to_Hz);
  Matrix basis = kept.vectors;
  Reduction r{.system = system, .modes = kept.elastic, .first_left_out_Hz = kept.first_left_out_Hz};
  if (o.static_correction && kept.elastic < elastic) {
    const ResidualVectors shapes = residual_vectors(system, kept, o.static_accuracy);
    r.static_error = shapes.error;
    r.static_shapes = static_cast<int>(shapes.columns.cols());
    basis.conservativeResize(Eigen::NoChange, basis.cols() + shapes.columns.cols());
    basis.rightCols(shapes.columns.cols()) = shapes.columns;
  }
  r.system = ritz_projection(system, basis);
  r.basis = std::move(basis);
  std::ostringstream text;
  text << r.modes << " of " << elastic << " modes";
  if (r.modes < elastic) text << " (the first left out at " << in_Hz(r.first_left_out_Hz) << ")";
  text << " and " << r.static_shapes << " static shapes: " << r.system.size() << " of " << system.size()
       << " unknowns";
  if (r.static_shapes > 0) text << ", static deflection under the loads to " << percent(r.static_error);
  r.what = text.str();
  return r;
}

Reduction craig_bampton(const System& system, const ReductionOptions& o) {
  CraigBampton fixed(system, nodes_to_keep(system, o.keep));
  Reduction r{.system = system};
  r.basis = fixed.basis(o.modes, o.up_to_Hz);
  r.modes = fixed.modes();
  r.static_shapes = fixed.boundary();
  r.first_left_out_Hz = fixed.first_left_out_Hz();
  r.system = ritz_projection(system, r.basis);
  std::ostringstream text;
  text << r.static_shapes << " unknowns kept and " << r.modes << " modes with them held";
  if (r.system.size() < system.size())
    text << " (the first left out at " << in_Hz(r.first_left_out_Hz) << ")";
  text << ": " << r.system.size() << " of " << system.size() << " unknowns";
  r.what = text.str();
  return r;
}

}  // namespace

Reduction reduce(const System& system, const ReductionOptions& options) {
  refuse_friction(system, "a reduction");
  refuse_controllers(system, "a reduction");
  check_options(system, options);
  return options.kind == ReductionOptions::Kind::modal ? modal(system, options)
                                                       : craig_bampton(system, options);
}

}  // namespace drev
