#pragma once
/// What an observer of one's own is made of: Observer, to derive from (observer.hpp), and the points of a run that
/// it is shown (evaluated_state.hpp). Values of channels there: Channel::evaluate() (core/channel.hpp).
///
///   class LargestSpeed final : public Observer {              // of any node, as deviation [rad/s]
///    public:
///     void start(const Assembler&, const EvaluatedState& point) override { take(point); }
///     void step(const Assembler&, const EvaluatedState&, const EvaluatedState& to) override { take(to); }
///     double value = 0.0;
///    private:
///     void take(const EvaluatedState& point) { value = std::max(value, point.state.v.cwiseAbs().maxCoeff()); }
///   };
///   LargestSpeed speed;
///   simulate(system, {.step = 1e-5, .t_end = 1.0}, {&speed});
#include <drev/solvers/run/evaluated_state.hpp>
#include <drev/solvers/run/observer.hpp>
