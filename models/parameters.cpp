#include <drev/models/parameters.hpp>

#include <algorithm>
#include <charconv>
#include <cmath>

namespace drev {

bool read_number(const std::string& text, double& value) {
  const bool plus = text.starts_with('+') && !text.starts_with("+-");
  const char* begin = text.data() + (plus ? 1 : 0);
  const char* end = text.data() + text.size();
  const auto result = std::from_chars(begin, end, value);
  return result.ec == std::errc{} && result.ptr == end && begin != end;
}

std::string Parameter::range() const {
  std::string text;
  switch (kind) {
    case Kind::number:
    case Kind::integer:
      if (low == -kNoLimit && high == kNoLimit) return "any finite number";
      if (low == -kNoLimit) return "<= " + to_text(high);
      if (high == kNoLimit) return ">= " + to_text(low);
      return to_text(low) + " to " + to_text(high);
    case Kind::choice:
      for (const std::string& c : choices) text += (text.empty() ? "" : " | ") + c;
      return text;
    case Kind::order:
      return "every number from 1 once, e.g. 1-5-3-6-2-4, or default";
  }
  return text;
}

Parameters::Parameters(std::string model, std::vector<Parameter> known)
    : model_(std::move(model)), known_(std::move(known)) {
  for (const Parameter& s : known_) values_.push_back(s.default_text);
}

void Parameters::set(const std::string& name, const std::string& value) {
  std::vector<std::string> names;
  for (const Parameter& s : known_) names.push_back(s.name);
  const auto found = std::find(names.begin(), names.end(), name);
  if (found == names.end()) {
    findings_.push_back(
        {model_, "parameter", name, "", "is no parameter of this model" + did_you_mean(name, names)});
    return;
  }
  const auto i = static_cast<std::size_t>(found - names.begin());
  const Parameter& s = known_[i];
  const std::string place = model_ + "/settings";
  if (s.kind == Parameter::Kind::choice) {
    if (std::find(s.choices.begin(), s.choices.end(), value) == s.choices.end()) {
      findings_.push_back(
          {place, name, value, "", "must be one of " + s.range() + did_you_mean(value, s.choices)});
      return;
    }
  } else if (s.kind == Parameter::Kind::order) {
    values_[i] = value;
    const std::vector<int> order = this->order(name);
    for (std::size_t k = 1; k <= order.size(); ++k)
      if (std::count(order.begin(), order.end(), static_cast<int>(k)) != 1) {
        findings_.push_back({place, name, value, "", "must be " + s.range()});
        values_[i] = s.default_text;
        return;
      }
    if (order.empty() && value != "default") {
      findings_.push_back({place, name, value, "", "must be " + s.range()});
      values_[i] = s.default_text;
    }
    return;
  } else {
    double number = 0.0;
    if (!read_number(value, number)) {
      findings_.push_back({place, name, value, "",
                           "is not a number; must be " + s.range() + (s.unit.empty() ? "" : " " + s.unit)});
      return;
    }
    if (!(number >= s.low && number <= s.high) ||
        (s.kind == Parameter::Kind::integer && number != std::floor(number))) {
      findings_.push_back(
          {place, name, value, s.unit,
           (s.kind == Parameter::Kind::integer ? "must be a whole number, " : "must be ") + s.range()});
      return;
    }
  }
  values_[i] = value;
}

void Parameters::check() const {
  if (!findings_.empty()) throw ModelError(findings_);
}

void Parameters::refuse(const std::string& name, const std::string& why) {
  const Parameter& s = known_[find(name)];
  findings_.push_back({model_ + "/settings", name, text(name), s.unit, why});
}

std::size_t Parameters::find(const std::string& name) const {
  for (std::size_t i = 0; i < known_.size(); ++i)
    if (known_[i].name == name) return i;
  throw ModelError({{model_, "parameter", name, "", "is no parameter of this model"}});
}

double Parameters::number(const std::string& name) const {
  double value = 0.0;
  read_number(values_[find(name)], value);
  return value;
}

int Parameters::integer(const std::string& name) const { return static_cast<int>(number(name)); }

const std::string& Parameters::text(const std::string& name) const { return values_[find(name)]; }

std::vector<int> Parameters::order(const std::string& name) const {
  std::vector<int> order;
  const std::string& all = values_[find(name)];
  for (std::size_t begin = 0; begin <= all.size();) {
    const std::size_t end = std::min(all.find('-', begin), all.size());
    double value = 0.0;
    if (!read_number(all.substr(begin, end - begin), value) || value != std::floor(value) ||
        std::abs(value) > 1e6)
      return {};
    order.push_back(static_cast<int>(value));
    begin = end + 1;
  }
  return order;
}

}  // namespace drev
