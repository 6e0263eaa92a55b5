#include <drev/core/error.hpp>

#include "app/base/output_file.hpp"
#include "python/bindings/request.hpp"

namespace drev::python {

namespace {

/// Raises the exception that a function of drev._errors makes from the arguments.
template <class... Arguments>
void raise(const char* function, Arguments&&... arguments) {
  const nb::object error =
      nb::module_::import_("drev._errors").attr(function)(std::forward<Arguments>(arguments)...);
  PyErr_SetObject(reinterpret_cast<PyObject*>(Py_TYPE(error.ptr())), error.ptr());
}

nb::str text_of(const std::string& text) {
  PyObject* decoded = PyUnicode_DecodeUTF8(text.data(), static_cast<Py_ssize_t>(text.size()), "replace");
  return nb::steal<nb::str>(decoded);
}

void translate(const std::exception_ptr& thrown, void* /*unused*/) {
  try {
    std::rethrow_exception(thrown);
  } catch (const ModelError& error) {
    nb::list findings;
    for (const Finding& f : error.findings())
      findings.append(nb::make_tuple(text_of(f.place), text_of(f.parameter), text_of(f.value),
                                     text_of(f.unit), text_of(f.range)));
    raise("model_error", findings);
  } catch (const SolverError& error) {
    raise("solver_error", text_of(error.what()));
  } catch (const app::OutputError& error) {
    raise("output_error", text_of(error.what()));
  }
}

}  // namespace

void bind_errors(nb::module_& /*module*/) { nb::register_exception_translator(translate); }

}  // namespace drev::python
