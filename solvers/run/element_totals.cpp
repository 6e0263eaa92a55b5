#include <drev/core/assembler.hpp>
#include <drev/solvers/run/element_totals.hpp>
#include <drev/solvers/run/evaluated_state.hpp>

#include <algorithm>

namespace drev {

namespace {

std::vector<Channel> those_of(const System& system, std::initializer_list<const char*> quantities) {
  std::vector<Channel> all = energy_channels(system);
  std::erase_if(all, [&](const Channel& c) {
    return std::none_of(quantities.begin(), quantities.end(),
                        [&](const char* quantity) { return c.name().ends_with(quantity); });
  });
  return all;
}

std::string element_of(const Channel& channel) { return channel.name().substr(0, channel.name().rfind('.')); }

}  // namespace

ElementTotals::ElementTotals(const System& system)
    : values_(those_of(system, {".work_J", ".dissipated_J"})),
      stored_(those_of(system, {".stored_J"})),
      begin_(values_.channels().size()),
      last_(values_.channels().size()) {}

void ElementTotals::look_through(StepMotion& motion) {
  values_.look_through(motion);
  stored_.look_through(motion);
}

void ElementTotals::start(const Assembler& assembler, const EvaluatedState& point) {
  values_.start(assembler, point);
  stored_.start(assembler, point);
  for (std::size_t c = 0; c < begin_.size(); ++c) begin_[c] = last_[c] = values_.value(c, assembler, point);
  t_begin_ = t_last_ = point.state.t;
}

void ElementTotals::step(const Assembler& assembler, const EvaluatedState& from, const EvaluatedState& to) {
  values_.step(assembler, from, to);
  stored_.step(assembler, from, to);
  for (std::size_t c = 0; c < last_.size(); ++c) last_[c] = values_.value(c, assembler, to);
  t_last_ = to.state.t;
}

void ElementTotals::restart(const Assembler& assembler, const EvaluatedState& point) {
  values_.restart(assembler, point);
  stored_.restart(assembler, point);
}

bool ElementTotals::needs_acceleration() const {
  return values_.needs_acceleration() || stored_.needs_acceleration();
}

bool ElementTotals::watches_loads() const { return values_.watches_loads() || stored_.watches_loads(); }

std::vector<ElementTotals::Row> ElementTotals::rows() const {
  std::vector<Row> rows;
  const auto row_of = [&](const Channel& channel) -> Row& {
    const std::string name = element_of(channel);
    const auto found =
        std::find_if(rows.begin(), rows.end(), [&](const Row& row) { return row.element == name; });
    if (found != rows.end()) return *found;
    rows.push_back({name, {}, {}, {}, t_last_ - t_begin_});
    return rows.back();
  };
  for (std::size_t c = 0; c < last_.size(); ++c) {
    const Channel& channel = values_.channels()[c];
    Row& row = row_of(channel);
    (channel.name().ends_with(".work_J") ? row.work : row.dissipated) = last_[c] - begin_[c];
  }
  for (std::size_t c = 0; c < stored_.peaks().size(); ++c)
    row_of(stored_.channels()[c]).largest_stored = stored_.peaks()[c].max;
  return rows;
}

}  // namespace drev
