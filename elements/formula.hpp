#pragma once
/// Formula: a number as a formula of a few variables, compiled from a text or put together step by step.
///
/// It is evaluated over Dual numbers, so that its slopes come with it, exactly, by forward differentiation. Each step is
/// an operation on earlier steps, the last one is the result. A formula is a value and pure: one serves many threads.
#include <drev/core/law/dual.hpp>

#include <span>
#include <string>
#include <vector>

namespace drev {

struct Ranged;

class Formula {
 public:
  enum class Op {
    constant,  ///< value
    variable,  ///< number a of the variables
    add,       ///< steps a and b
    subtract,
    multiply,
    divide,
    smaller,
    larger,
    negate,  ///< step a
    power,   ///< step a to the power `value`
    sqrt,    ///< of step a, like all that follow
    abs,
    exp,
    log,
    sin,
    cos,
    tan,
    tanh,
    atan,
  };
  struct Step {
    Op op = Op::constant;
    int a = -1, b = -1;
    double value = 0.0;
  };

  Formula() = default;  ///< 0
  /// Steps that refer to none behind them; else std::invalid_argument.
  explicit Formula(std::vector<Step> steps);

  const std::vector<Step>& steps() const { return steps_; }
  /// At these values of the variables, in the order of their numbers; a variable that is not there is 0.
  Dual at(std::span<const Dual> variables) const;
  /// The range of it over ranges of the variables, and of its slopes.
  Ranged over(std::span<const Ranged> variables) const;
  /// As an expression of a model file with these names for the variables.
  std::string text(std::span<const std::string> names) const;

 private:
  template <class T>
  T evaluate(std::span<const T> variables) const;
  std::vector<Step> steps_;
};

}  // namespace drev
