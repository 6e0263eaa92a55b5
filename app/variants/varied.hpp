#pragma once
/// The argument of one --vary for a parameter: values, or a distribution that --sample draws from.
///
///   NAME=A,B,C   NAME=FIRST:STEP:LAST   both mixed    values, the last one included where the steps lead to it
///   NAME=orders(N)                                    every order 1-...-N that begins with 1: (N - 1)! of them
///   NAME=uniform(LOW,HIGH)                            all values between them equally likely
///   NAME=normal(MEAN,DEVIATION)                       normally distributed, by mean and standard deviation > 0
#include <drev/core/error.hpp>
#include <drev/models/model_case.hpp>

#include <cstdint>
#include <string>
#include <vector>

namespace drev::app {

struct Varied {
  enum class Kind { values, orders, uniform, normal };
  std::string name, text;  ///< name of the parameter; text given after it
  Kind kind = Kind::values;
  std::vector<std::string> values = {};
  int items = 0;                     ///< number of items N of orders(N)
  double first = 0.0, second = 0.0;  ///< low and high, or mean and standard deviation
  /// Number of values; 0: a continuous distribution.
  std::uint64_t count() const;
  /// Value number i < count().
  std::string value(std::uint64_t i) const;
  /// Of a uniform distribution: the value at u of its range, 0 to 1, to 12 digits.
  std::string between(double u) const;
};

/// most: largest number of combinations of all values; 0: they are not combined. Faults are added to
/// findings.
std::vector<Varied> read_varied(const std::vector<std::string>& words, double most,
                                std::vector<Finding>& findings);

/// All values of lists, each with the name of its parameter.
ParameterValues listed_values(const std::vector<Varied>& varied);

/// Order number i of (N - 1)! in lexicographic order, as "1-3-2".
std::string order_text(std::uint64_t i, int items);

}  // namespace drev::app
