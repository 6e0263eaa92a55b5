#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include "app/commands/modes_request.hpp"
#include "python/bindings/arrays.hpp"
#include "python/bindings/request.hpp"

namespace drev::python {

namespace {

const char* word_of(Contact contact) { return contact == Contact::closed ? "closed" : "open"; }

struct Modes {
  ModeSet set;
  std::vector<std::string> nodes;
  std::string model;
};

/// The oscillating damped modes, and their figures as arrays.
struct Damped {
  app::DampedModes found;
  std::vector<std::string> nodes;
  std::string model;
  std::vector<std::complex<double>> lambda = {};
  std::vector<double> frequency_Hz = {}, natural_frequency_Hz = {}, damping_ratio = {};
};

Modes* modes(const Request& asked) {
  const app::CommandLine line = asked.line();
  Watch watch(asked);
  const nb::gil_scoped_release unlocked;
  const app::ModesRequest request = app::request_modes(line);
  return new Modes{solve_modes(request.model.system, request.options), request.model.system.node_names(),
                   request.model.entry->name};
}

Modes* modes_of_system(const System& system, std::optional<int> count, const std::string& contact) {
  if (contact != "closed" && contact != "open")
    throw nb::value_error(("contact must be closed or open, not " + contact).c_str());
  const nb::gil_scoped_release unlocked;
  const Contact state = contact == "closed" ? Contact::closed : Contact::open;
  return new Modes{solve_modes(system, {.count = count, .contact = state}), system.node_names(),
                   system.name()};
}

Damped* damped_modes(const Request& asked) {
  app::CommandLine line = asked.line();
  line.options["--damped"] = {};
  Watch watch(asked);
  std::unique_ptr<Damped> all;
  try {
    const nb::gil_scoped_release unlocked;
    const auto request = std::make_shared<const app::ModesRequest>(app::request_modes(line));
    all = std::make_unique<Damped>(Damped{answered([request] { return app::find_damped_modes(*request); }),
                                          request->model.system.node_names(), request->model.entry->name});
  } catch (const app::Interruption&) {  // as watch says
  }
  watch.raise_if_stopped();
  for (std::size_t i = 0; i < all->found.count; ++i) {
    const DampedMode& mode = all->found.set.modes[i];
    all->lambda.push_back(mode.lambda);
    all->frequency_Hz.push_back(mode.frequency_Hz);
    all->natural_frequency_Hz.push_back(mode.natural_frequency_Hz);
    all->damping_ratio.push_back(mode.damping_ratio);
  }
  return all.release();
}

}  // namespace

nb::object modes_of(const System& system, std::optional<int> count, const std::string& contact) {
  return nb::cast(modes_of_system(system, count, contact), nb::rv_policy::take_ownership);
}

void bind_modes(nb::module_& module) {
  nb::class_<Modes>(module, "Modes")
      .def_prop_ro("frequency_Hz",
                   [](nb::handle s) { return array_of(nb::cast<const Modes&>(s).set.frequency_Hz, s); })
      .def_prop_ro("error_Hz",
                   [](nb::handle s) { return array_of(nb::cast<const Modes&>(s).set.error_Hz, s); })
      .def_prop_ro("shapes",
                   [](nb::handle s) {
                     const ModeSet& set = nb::cast<const Modes&>(s).set;
                     return matrix_of(set.shapes, set.frequency_Hz.size(), s);
                   })
      .def_prop_ro("rigid_modes", [](const Modes& m) { return m.set.rigid_modes; })
      .def_prop_ro("contact", [](const Modes& m) { return word_of(m.set.contact); })
      .def_prop_ro("how", [](const Modes& m) { return m.set.summary.brief(); })
      .def_ro("nodes", &Modes::nodes)
      .def_ro("model", &Modes::model);
  nb::class_<Damped>(module, "DampedModes")
      .def_prop_ro("eigenvalues", [](nb::handle s) { return array_of(nb::cast<const Damped&>(s).lambda, s); })
      .def_prop_ro("frequency_Hz",
                   [](nb::handle s) { return array_of(nb::cast<const Damped&>(s).frequency_Hz, s); })
      .def_prop_ro("natural_frequency_Hz",
                   [](nb::handle s) { return array_of(nb::cast<const Damped&>(s).natural_frequency_Hz, s); })
      .def_prop_ro("damping_ratio",
                   [](nb::handle s) { return array_of(nb::cast<const Damped&>(s).damping_ratio, s); })
      .def_prop_ro("real_eigenvalues",
                   [](nb::handle s) { return array_of(nb::cast<const Damped&>(s).found.set.real_lambda, s); })
      .def_prop_ro("shapes",
                   [](nb::handle s) {
                     const Damped& d = nb::cast<const Damped&>(s);
                     return matrix_of(d.found.set.shapes, d.found.count, s);
                   })
      .def("energy",
           [](nb::handle s, const std::string& kind) {
             const Damped& d = nb::cast<const Damped&>(s);
             const ModeEnergy& e = d.found.energy;
             return matrix_of(kind == "kinetic"   ? e.kinetic
                              : kind == "elastic" ? e.elastic
                                                  : e.dissipated,
                              d.found.count, s);
           })
      .def_prop_ro("elements", [](const Damped& d) { return d.found.energy.elements; })
      .def_prop_ro("rigid_modes", [](const Damped& d) { return d.found.set.rigid_modes; })
      .def_prop_ro("contact", [](const Damped& d) { return word_of(d.found.set.contact); })
      .def_ro("nodes", &Damped::nodes)
      .def_ro("model", &Damped::model);
  module.def("modes", &modes, nb::arg("request"), nb::rv_policy::take_ownership);
  module.def("damped_modes", &damped_modes, nb::arg("request"), nb::rv_policy::take_ownership);
}

}  // namespace drev::python
