// The extension module drev._drev, on which the package's Python code (python/drev) is built. Its names are
// internal.
#include "app/fmi/import/fmu.hpp"
#include "python/bindings/request.hpp"

NB_MODULE(_drev, module) {
  // Results and models that live until the interpreter ends are no leak.
  nanobind::set_leak_warnings(false);
  drev::app::register_fmu();
  drev::python::Computing::end_process_at_once();
  drev::python::bind_errors(module);
  drev::python::bind_commands(module);
  drev::python::bind_run(module);
  drev::python::bind_modes(module);
  drev::python::bind_system(module);
  drev::python::bind_callables(module);
  drev::python::bind_study(module);
}
