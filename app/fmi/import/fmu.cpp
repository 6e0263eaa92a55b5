#include "app/fmi/import/fmu.hpp"

#include <drev/app/model_file/element_table.hpp>

#include <cmath>
#include <cstdint>
#include <limits>
#include <set>

#include "app/fmi/import/imported_instance.hpp"

namespace drev::app {

namespace {

using D = Dimension;
using Type = ImportedVariable::Type;

/// The fault of a variable that is to have this causality; empty: there is none.
std::string fault_of(const FmuDescription& fmu, const std::string& name, const char* causality, bool real) {
  const ImportedVariable* v = fmu.find(name);
  const auto article = [](const std::string& word) {
    return (word.starts_with("i") || word.starts_with("o") ? "an " : "a ") + word;
  };
  if (v == nullptr || v->causality != causality) {
    const std::vector<std::string> names = fmu.names(causality);
    std::string known;
    for (const std::string& other : names) known += (known.empty() ? "" : ", ") + other;
    const std::string hint = did_you_mean(name, names);
    const std::string there = !hint.empty() ? hint : known.empty() ? "; it has none" : "; there are " + known;
    return (v == nullptr ? "is no variable of the FMU" : "is " + article(v->causality) + " of the FMU") +
           ", and must be " + article(causality) + there;
  }
  if (v->array) return "is an array; drev takes scalars";
  if (real && v->type != Type::real)
    return "is of type " + v->type_name + "; drev takes Real (FMI 2) and Float64";
  if (v->type == Type::other)
    return "is of type " + v->type_name +
           "; drev sets Real, Integer, Boolean and String, and of FMI 3 Float64, Int32, "
           "Boolean and String";
  return {};
}

/// What is wrong with a value for a parameter, which no rounding may change; empty: nothing.
std::string fault_of_value(const ImportedVariable& v, double value) {
  constexpr Range kInteger{std::numeric_limits<std::int32_t>::min(),
                           std::numeric_limits<std::int32_t>::max()};
  if (v.type == Type::integer &&
      !(value == std::trunc(value) && value >= kInteger.low && value <= kInteger.high))
    return "is of an integer, which must be a whole number from " + to_text(kInteger.low) + " to " +
           to_text(kInteger.high);
  if (v.type == Type::boolean && value != 0.0 && value != 1.0) return "is of a Boolean, which must be 0 or 1";
  if (value < v.low || value > v.high)
    return "must be " +
           (std::isinf(v.low)    ? "<= " + to_text(v.high)
            : std::isinf(v.high) ? ">= " + to_text(v.low)
                                 : "from " + to_text(v.low) + " to " + to_text(v.high)) +
           ", as the FMU declares";
  return {};
}

class FmuSession final : public ControlSession {
 public:
  FmuSession(const Fmu::Params& params, const std::shared_ptr<const UnpackedFmu>& fmu, double t_start,
             double t_end)
      : params_(params), description_(fmu->description()), t_start_(t_start), t_end_(t_end) {
    instance_ = instantiate(fmu, "drev");
  }

  void start(std::span<const double> inputs, std::span<double> outputs) override {
    for (const Fmu::Parameter& p : params_.parameters) {
      const ImportedVariable& v = *description_.find(p.variable);
      if (v.type == Type::text)
        instance_->set_text(v, p.text);
      else
        instance_->set(v, p.value);
    }
    instance_->enter_initialization(t_start_, t_end_);
    set(inputs);
    instance_->exit_initialization();
    get(outputs);
  }

  void step(double t, double h, std::span<const double> before, std::span<const double> inputs,
            std::span<double> outputs) override {
    set(params_.interpolate_inputs ? before : inputs);
    if (params_.interpolate_inputs)
      for (std::size_t i = 0; i < inputs.size(); ++i)
        instance_->set_slope(*description_.find(params_.inputs[i].variable), (inputs[i] - before[i]) / h);
    instance_->step(t, h);
    get(outputs);
  }

  std::string warning() const override { return instance_->warning(); }

 private:
  void set(std::span<const double> inputs) {
    for (std::size_t i = 0; i < inputs.size(); ++i)
      instance_->set(*description_.find(params_.inputs[i].variable), inputs[i]);
  }
  void get(std::span<double> outputs) {
    for (std::size_t j = 0; j < outputs.size(); ++j) {
      const Fmu::Output& output = params_.outputs[j];
      const double y = instance_->get(*description_.find(output.variable));
      if (!std::isfinite(y))
        throw std::runtime_error(params_.file + ": output " + output.variable + " is not finite");
      outputs[j] = output.factor * y;
    }
  }

  const Fmu::Params& params_;
  const FmuDescription& description_;
  double t_start_, t_end_;
  std::unique_ptr<ImportedInstance> instance_;
};

}  // namespace

const double Fmu::Parameter::kNotSet = std::numeric_limits<double>::quiet_NaN();

Fmu::Fmu(Params params)
    : SampledController(params.step, params.hold, params.outputs.size()), params_(std::move(params)) {
  if (params_.file.empty()) return;
  try {
    fmu_ = unpacked_fmu(params_.file);
  } catch (const std::exception& error) {
    fault_ = error.what();
  }
}

void Fmu::check(ParameterCheck& check) const {
  SampledController::check(check);
  if (params_.outputs.empty()) check.fail("outputs", "0", "entries", "must have one a node");
  for (const Output& output : params_.outputs) check.finite("factor", output.factor, "");
  if (!fmu_) {
    check.fail("file", params_.file, "", params_.file.empty() ? "must be the name of an FMU" : fault_);
    return;
  }
  const FmuDescription& fmu = fmu_->description();
  std::set<std::string> names;
  const auto look = [&](const char* where, const std::string& name, const char* causality, bool real) {
    const std::string fault = fault_of(fmu, name, causality, real);
    if (!fault.empty())
      check.fail(where, name, "", fault);
    else if (!names.insert(name).second)
      check.fail(where, name, "", "is there twice");
    return fault.empty();
  };
  for (const Input& input : params_.inputs) look("inputs", input.variable, "input", true);
  for (const Output& output : params_.outputs) look("outputs", output.variable, "output", true);
  for (const Parameter& p : params_.parameters) {
    if (!look("parameters", p.variable, "parameter", false)) continue;
    const ImportedVariable& variable = *fmu.find(p.variable);
    const bool text = variable.type == Type::text;
    if (!text && !std::isfinite(p.value))
      check.fail("parameters", p.variable, "", "must have a value that is a finite number");
    else if (const std::string fault = fault_of_value(variable, p.value); !fault.empty())
      check.fail("parameters", p.variable + " = " + to_text(p.value), "", fault);
    if (text && !std::isnan(p.value))
      check.fail("parameters", p.variable, "", "is a text: give text, not value");
  }
  if (params_.interpolate_inputs && !fmu.interpolates_inputs)
    check.fail("interpolate_inputs", "true", "",
               "is for FMUs of FMI 2.0 that say canInterpolateInputs; this one does not");
}

std::vector<std::string> Fmu::inputs() const {
  std::vector<std::string> all;
  for (const Input& input : params_.inputs) all.push_back(input.channel);
  return all;
}

std::unique_ptr<ControlSession> Fmu::open(double t_start, double t_end) const {
  return std::make_unique<FmuSession>(params_, fmu_, t_start, t_end);
}

void list(Fields& f, Fmu::Params& p) {
  f.file("file", p.file, Need::required);
  f.number({"step", D::time}, p.step, Need::required);
  int hold = static_cast<int>(p.hold);
  f.choice("hold", {"zero_order", "first_order"}, hold);
  p.hold = static_cast<Hold>(hold);
  f.flag("interpolate_inputs", p.interpolate_inputs);
  const auto rows = [&](const char* name, auto& all, const auto& list_row) {
    if (!f.reading() && all.empty()) return;
    f.rows(
        name, all.size(), [&](std::size_t count) { all.resize(count); },
        [&](Fields& g, std::size_t i) {
          g.text("variable", all[i].variable);
          list_row(g, all[i]);
        });
  };
  rows("inputs", p.inputs, [](Fields& g, Fmu::Input& input) { g.text("channel", input.channel); });
  rows("outputs", p.outputs, [](Fields& g, Fmu::Output& output) {
    g.number({"factor", D::none}, output.factor);
  });
  rows("parameters", p.parameters, [](Fields& g, Fmu::Parameter& parameter) {
    const bool read = g.reading();
    if (read || parameter.text.empty()) g.number({"value", D::none}, parameter.value);
    if (read || !parameter.text.empty()) g.text("text", parameter.text);
  });
}

void register_fmu() {
  if (find_element_type("fmu") == nullptr)
    register_element_type(element_type<Fmu>("fmu", [](Fields& f, Fmu::Params& p) { list(f, p); }));
}

}  // namespace drev::app
