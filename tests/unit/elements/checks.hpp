#pragma once
/// Shared by the tests of the catalogue.
#include <drev/core/element.hpp>
#include <drev/core/verify.hpp>

#include <string>

namespace drev::test {

/// Every finding of check(), one a line; empty if the parameters are sound.
inline std::string findings(const Element& element) {
  std::vector<Finding> all;
  ParameterCheck check("place", all);
  element.check(check);
  std::string text;
  for (const Finding& f : all) text += (text.empty() ? "" : "\n") + f.text();
  return text;
}

inline bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

inline Terms described(const Element& element, int nodes) {
  const int n = nodes + static_cast<int>(element.internal_nodes().size());
  Terms terms(n);
  element.describe(n, terms);
  return terms;
}

/// Composite midpoint rule: an integral that shares no code with the library.
template <class F>
double integral(F f, double from, double to, int steps) {
  const double h = (to - from) / steps;
  double sum = 0.0;
  for (int i = 0; i < steps; ++i) sum += f(from + (i + 0.5) * h);
  return h * sum;
}

}  // namespace drev::test
