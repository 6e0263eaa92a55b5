#pragma once
/// What one --vary gives to a parameter: values, or a distribution that --sample draws from.
///
///   NAME=A,B,C   NAME=FIRST:STEP:LAST   both mixed    values, the last one included where the steps lead to it
///   NAME=orders(N)                                    every order 1-...-N that begins with 1: (N - 1)! of them
///   NAME=uniform(LOW,HIGH)                            every value between them as likely
///   NAME=normal(MEAN,DEVIATION)                       normally distributed, by mean and standard deviation > 0
#include <drev/core/error.hpp>
#include <drev/models/model_case.hpp>

#include <cstdint>
#include <string>
#include <vector>

namespace drev::app {

struct Varied {
  enum class Kind { values, orders, uniform, normal };
  std::string name, text;  ///< of the parameter; what was given behind it
  Kind kind = Kind::values;
  std::vector<std::string> values = {};
  int items = 0;                     ///< of orders
  double first = 0.0, second = 0.0;  ///< low and high, or mean and standard deviation
  /// How many values there are; 0: a continuous distribution.
  std::uint64_t count() const;
  /// Value number i < count().
  std::string value(std::uint64_t i) const;
};

/// most: so many combinations of all values at the most; 0: they are not combined. What is wrong goes to findings.
std::vector<Varied> read_varied(const std::vector<std::string>& words, double most,
                                std::vector<Finding>& findings);

/// Order number i of (N - 1)! in lexicographic order, as "1-3-2".
std::string order_text(std::uint64_t i, int items);

}  // namespace drev::app
