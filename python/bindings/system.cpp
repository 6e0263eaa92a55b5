#include <drev/core/assembler.hpp>
#include <drev/core/channel.hpp>

#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include "app/cli/model_option.hpp"
#include "python/bindings/arrays.hpp"
#include "python/bindings/request.hpp"
#include "solvers/linear/sparse_cholesky.hpp"

namespace drev::python {

namespace {

using Given = nb::ndarray<const double, nb::ndim<1>, nb::c_contig, nb::device::cpu>;
using Taken = nb::ndarray<double, nb::ndim<1>, nb::c_contig, nb::device::cpu>;

/// A built model and its evaluation at a state. One thread at a time: Python's lock is kept.
class BuiltModel {
 public:
  explicit BuiltModel(app::ModelRequest model)
      : model_(std::move(model)),
        assembler_(model_.system),
        state_(State::initial(model_.system)),
        force_(model_.system.size()),
        product_(model_.system.size()) {}
  BuiltModel(const BuiltModel&) = delete;
  BuiltModel& operator=(const BuiltModel&) = delete;

  const System& system() const { return model_.system; }

  /// Sets `out` to p - C v - K z - sum b y - f, with f of the general elements.
  void force(double t, const Given& z, const Given& v, const Taken& out) {
    take(t, z, v, out);
    find_force();
    Eigen::Map<Vector>(out.data(), force_.size()) = force_;
  }
  /// M^-1 times this force.
  void acceleration(double t, const Given& z, const Given& v, const Taken& out) {
    take(t, z, v, out);
    find_force();
    if (mass_.status() == FactorStatus::not_computed &&
        mass_.factorize(system().pattern(), system().mass_values()) != FactorStatus::success)
      throw SolverError(system().name() + ": the mass matrix is " + to_text(mass_.status()) +
                        ": a node without inertia has no acceleration of its own");
    mass_.solve(force_, force_);
    Eigen::Map<Vector>(out.data(), force_.size()) = force_;
  }

 private:
  void take(double t, const Given& z, const Given& v, const Taken& out) {
    const auto size = static_cast<std::size_t>(system().size());
    if (z.shape(0) != size || v.shape(0) != size || out.shape(0) != size)
      throw nb::value_error(("deviations, rates and out must have one entry for each of the " +
                             std::to_string(size) + " unknowns (System.unknowns)")
                                .c_str());
    state_.z = Eigen::Map<const Vector>(z.data(), system().size());
    state_.v = Eigen::Map<const Vector>(v.data(), system().size());
    if (t != assembler_.time()) assembler_.set_time(t);
  }
  void find_force() {
    assembler_.external(state_.z, state_.v, force_);
    assembler_.multiply_damping(state_.v, product_);
    force_ -= product_;
    assembler_.multiply_stiffness(state_.z, product_);
    force_ -= product_;
    if (system().scalars().empty() && system().generals().empty()) return;
    product_.setZero();
    assembler_.add_scalar_forces(state_.z, state_.v, product_);
    history_.resize(state_.history.size());
    assembler_.add_general_forces(state_.z, state_.v, state_.history, product_, history_);
    force_ -= product_;
  }

  app::ModelRequest model_;
  Assembler assembler_;
  State state_;
  Vector force_, product_, history_;
  SparseCholesky mass_;
};

/// A matrix in the form that scipy.sparse.csc_matrix accepts: values, row indices, column starts.
nb::tuple compressed(const Vector& values, nb::handle owner) {
  const SparseMatrix& pattern = nb::cast<const BuiltModel&>(owner).system().pattern();
  const auto entries = static_cast<std::size_t>(pattern.nonZeros());
  return nb::make_tuple(
      ReadOnly<double>(values.data(), {static_cast<std::size_t>(values.size())}, owner),
      ReadOnly<int>(pattern.innerIndexPtr(), {entries}, owner),
      ReadOnly<int>(pattern.outerIndexPtr(), {static_cast<std::size_t>(pattern.outerSize()) + 1}, owner));
}

BuiltModel* build(const Request& asked) {
  const app::CommandLine line = asked.line();
  const nb::gil_scoped_release unlocked;
  return new BuiltModel(app::request_model(line));
}

}  // namespace

void bind_system(nb::module_& module) {
  nb::class_<BuiltModel>(module, "System")
      .def_prop_ro("size", [](const BuiltModel& b) { return b.system().size(); })
      .def_prop_ro("node_names", [](const BuiltModel& b) { return b.system().node_names(); })
      .def_prop_ro("unknowns",
                   [](const BuiltModel& b) {
                     std::vector<std::string> names;
                     for (int k = 0; k < b.system().size(); ++k) names.push_back(b.system().unknown_name(k));
                     return names;
                   })
      .def_prop_ro("channels",
                   [](const BuiltModel& b) {
                     std::vector<std::pair<std::string, std::string>> all;
                     for (const Channel& c : all_channels(b.system())) all.emplace_back(c.name(), c.unit());
                     return all;
                   })
      .def_prop_ro("breakpoints",
                   [](nb::handle self) {
                     return array_of(nb::cast<const BuiltModel&>(self).system().breakpoints(), self);
                   })
      .def_prop_ro("initial",
                   [](nb::handle self) {
                     const System& s = nb::cast<const BuiltModel&>(self).system();
                     const auto size = static_cast<std::size_t>(s.size());
                     return nb::make_tuple(ReadOnly<double>(s.initial_deviation().data(), {size}, self),
                                           ReadOnly<double>(s.initial_rate().data(), {size}, self));
                   })
      .def("matrix",
           [](nb::handle self, const std::string& which) {
             const System& s = nb::cast<const BuiltModel&>(self).system();
             return compressed(which == "mass"      ? s.mass_values()
                               : which == "damping" ? s.damping_values()
                                                    : s.stiffness_values(),
                               self);
           })
      .def(
          "modes",
          [](const BuiltModel& b, std::optional<int> count, const std::string& contact) {
            return modes_of(b.system(), count, contact);
          },
          nb::arg("count").none(), nb::arg("contact"))
      .def("force", &BuiltModel::force, nb::arg("t"), nb::arg("deviations"), nb::arg("rates"),
           nb::arg("out").noconvert())
      .def("acceleration", &BuiltModel::acceleration, nb::arg("t"), nb::arg("deviations"), nb::arg("rates"),
           nb::arg("out").noconvert());  // a converted copy would be filled, and dropped
  module.def("build", &build, nb::arg("request"), nb::rv_policy::take_ownership);
}

}  // namespace drev::python
