// Laws and loads that are Python callables, as types of elements of model files: python_law and python_load. A model
// made in Python names its callables by number. Each call takes the interpreter's lock, which makes it about
// a thousand times as expensive as a law of the catalogue.
#include <drev/app/model_file/element_table.hpp>
#include <drev/core/element.hpp>
#include <drev/core/load.hpp>
#include <drev/core/scalar_force.hpp>

#include <cmath>
#include <mutex>
#include <nanobind/stl/shared_ptr.h>
#include <nanobind/stl/string.h>

#include "python/bindings/request.hpp"

namespace drev::python {

namespace {

/// A callable, and its name in messages ("law 'coupling'").
class Callable {
 public:
  Callable(nb::object function, nb::object energy, std::string label)
      : function_(std::move(function)), energy_(std::move(energy)), label_(std::move(label)) {}
  ~Callable() {
    if (!nb::is_alive()) {  // the interpreter has ended before the last model
      function_.release();
      energy_.release();
      return;
    }
    const nb::gil_scoped_acquire locked;
    function_.reset();
    energy_.reset();
  }
  Callable(const Callable&) = delete;
  Callable& operator=(const Callable&) = delete;

  bool has_energy() const { return !energy_.is_none(); }
  const std::string& label() const { return label_; }

  /// The answer of a callable: a number, or three: the force and its two slopes. The lock must be held.
  struct Answer {
    double force = 0.0, first_slope = 0.0, second_slope = 0.0;
    bool slopes = false;
  };
  template <class... Arguments>
  Answer call(Arguments... arguments) const {
    const nb::object given = called(function_, arguments...);
    Answer answer;
    if (PyTuple_Check(given.ptr()) && PyTuple_GET_SIZE(given.ptr()) == 3) {
      answer = {number(given[0]), number(given[1]), number(given[2]), true};
    } else {
      answer.force = number(given);
    }
    if (!std::isfinite(answer.force) || !std::isfinite(answer.first_slope) ||
        !std::isfinite(answer.second_slope)) {
      std::string all;
      ((all += (all.empty() ? "" : ", ") + to_text(arguments)), ...);
      throw SolverError(label_ + ": its Python callable returned " + nb::cast<std::string>(nb::str(given)) +
                        " at (" + all + "); it must return finite numbers");
    }
    return answer;
  }
  double energy(double x) const { return number(called(energy_, x)); }

 private:
  /// Ctrl-C that comes while the callable runs ends the run, not the callable.
  template <class... Arguments>
  static nb::object called(const nb::object& function, Arguments... arguments) {
    try {
      return function(arguments...);
    } catch (const nb::python_error& error) {
      if (!error.matches(PyExc_KeyboardInterrupt) || !Watch::stop_current()) throw;
    }
    return function(arguments...);
  }
  double number(nb::handle value) const {
    const double x = PyFloat_AsDouble(value.ptr());
    if (x != -1.0 || PyErr_Occurred() == nullptr) return x;
    PyErr_Clear();
    throw nb::type_error((label_ +
                          ": its Python callable must return a number, or the force with its two slopes as "
                          "a tuple of three, not " +
                          nb::cast<std::string>(nb::repr(value)))
                             .c_str());
  }

  nb::object function_, energy_;
  std::string label_;
};

/// The callables of all existing models, by number.
class Registry {
 public:
  int add(std::shared_ptr<const Callable> callable) {
    const std::lock_guard lock(mutex_);
    all_.emplace(++last_, std::move(callable));
    return last_;
  }
  std::shared_ptr<const Callable> find(int number) {
    const std::lock_guard lock(mutex_);
    const auto found = all_.find(number);
    return found == all_.end() ? nullptr : found->second;
  }
  void remove(int number) {
    std::shared_ptr<const Callable> last;  // destroyed after unlocking: it may take the interpreter's lock
    const std::lock_guard lock(mutex_);
    if (const auto found = all_.find(number); found != all_.end()) {
      last = std::move(found->second);
      all_.erase(found);
    }
  }

 private:
  std::mutex mutex_;
  std::map<int, std::shared_ptr<const Callable>> all_;
  int last_ = 0;
};

Registry& registry() {
  static Registry all;
  return all;
}

/// Keeps a callable registered; a model made in Python holds it.
struct Registered {
  int number;
  explicit Registered(std::shared_ptr<const Callable> callable)
      : number(registry().add(std::move(callable))) {}
  ~Registered() { registry().remove(number); }
  Registered(const Registered&) = delete;
  Registered& operator=(const Registered&) = delete;
};

void check_callable(const std::shared_ptr<const Callable>& callable, int number, ParameterCheck& check) {
  if (!callable)
    check.fail("callable", std::to_string(number), "", "must be a callable of a model that still exists");
}

const double kStep = std::cbrt(2.3e-16);  // relative step of central differences [-]

double central(const auto& f, double x, double least) {
  const double h = kStep * std::max(std::abs(x), least);
  return (f(x + h) - f(x - h)) / (2.0 * h);
}

/// y = f(x, x', t). Its work counts as dissipated; if the energy V(x) is given, only the work of y - y at
/// rest does.
class PythonLaw final : public Element, public ScalarForce {
 public:
  explicit PythonLaw(int number) : number_(number), callable_(registry().find(number)) {}
  std::string_view type() const override { return "Python law"; }
  int min_nodes() const override { return 1; }
  int max_nodes() const override { return 2; }
  void check(ParameterCheck& check) const override { check_callable(callable_, number_, check); }
  void describe(int nodes, Terms& terms) const override {
    terms.scalars.push_back({.b = relative_motion(nodes), .force = this});
    terms.speed_ratio_constraints.push_back({.b = relative_motion(nodes)});
  }
  ScalarResponse evaluate(const ScalarInput& in) const override {
    const nb::gil_scoped_acquire locked;
    const Callable& f = *callable_;
    Callable::Answer y = f.call(in.x, in.x_dot, in.t);
    if (!y.slopes) {
      y.first_slope = central([&](double x) { return f.call(x, in.x_dot, in.t).force; }, in.x, 1e-4);
      y.second_slope = central([&](double v) { return f.call(in.x, v, in.t).force; }, in.x_dot, 1e-2);
    }
    const double at_rest = f.has_energy() ? f.call(in.x, 0.0, in.t).force : 0.0;
    return {.y = y.force,
            .dy_dx = y.first_slope,
            .dy_dx_dot = y.second_slope,
            .stored_energy = f.has_energy() ? f.energy(in.x) : 0.0,
            .dissipated_power = (y.force - at_rest) * in.x_dot};
  }
  // An energy that is given is one of x alone. Of no energy there is nothing to compare, and the law is not called for it.
  bool varies() const override { return callable_ == nullptr || !callable_->has_energy(); }

 private:
  int number_;
  std::shared_ptr<const Callable> callable_;
};

/// A load p(t) or p(t, theta, theta') on the right side.
class PythonLoad final : public Element, public Load {
 public:
  PythonLoad(int number, bool of_motion, std::vector<double> breakpoints)
      : number_(number),
        of_motion_(of_motion),
        breakpoints_(std::move(breakpoints)),
        callable_(registry().find(number)) {}
  std::string_view type() const override { return "Python load"; }
  int min_nodes() const override { return 1; }
  void check(ParameterCheck& check) const override {
    check_callable(callable_, number_, check);
    check.all_finite("breakpoints", breakpoints_, "s");
  }
  void describe(int /*nodes*/, Terms& terms) const override { terms.loads.push_back({0, this}); }
  LoadResponse evaluate(const LoadInput& in) const override {
    const nb::gil_scoped_acquire locked;
    const Callable& f = *callable_;
    if (!of_motion_) return {.torque = f.call(in.t).force};
    const double angle = in.nominal_angle + in.deviation;
    Callable::Answer p = f.call(in.t, angle, in.speed);
    if (!p.slopes) {
      p.first_slope = central([&](double x) { return f.call(in.t, x, in.speed).force; }, angle, 1e-4);
      p.second_slope = central([&](double v) { return f.call(in.t, angle, v).force; }, in.speed, 1e-2);
    }
    return {.torque = p.force, .dtorque_dangle = p.first_slope, .dtorque_dspeed = p.second_slope};
  }
  bool depends_on_motion() const override { return of_motion_; }
  std::vector<double> breakpoints() const override { return breakpoints_; }

 private:
  int number_;
  bool of_motion_;
  std::vector<double> breakpoints_;
  std::shared_ptr<const Callable> callable_;
};

/// A file cannot hold them.
bool is_never_written(const Element& /*element*/, const app::VisitFields& /*write*/) { return false; }

void register_types() {
  using app::Fields;
  app::register_element_type({.name = "python_law",
                              .make = [](const app::VisitFields& read) -> std::shared_ptr<const Element> {
                                int number = 0;
                                read([&](Fields& f) { f.whole("callable", number, app::Need::required); });
                                return std::make_shared<PythonLaw>(number);
                              },
                              .list = is_never_written});
  app::register_element_type({.name = "python_load",
                              .make = [](const app::VisitFields& read) -> std::shared_ptr<const Element> {
                                int number = 0;
                                bool of_motion = false;
                                std::vector<double> times;
                                read([&](Fields& f) {
                                  f.whole("callable", number, app::Need::required);
                                  f.flag("of_motion", of_motion);
                                  f.columns("breakpoints", {{{"time", app::Dimension::time}, &times}});
                                });
                                return std::make_shared<PythonLoad>(number, of_motion, std::move(times));
                              },
                              .list = is_never_written});
}

}  // namespace

void bind_callables(nb::module_& module) {
  register_types();
  nb::class_<Registered>(module, "Registered")
      .def(
          "__init__",
          [](Registered* self, nb::object function, nb::object energy, std::string label) {
            new (self) Registered(
                std::make_shared<const Callable>(std::move(function), std::move(energy), std::move(label)));
          },
          nb::arg("function"), nb::arg("energy").none(), nb::arg("label"))
      .def_ro("number", &Registered::number);
}

}  // namespace drev::python
