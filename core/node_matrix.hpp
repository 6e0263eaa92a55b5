#pragma once
/// A symmetric matrix over nodes, as the elements add to it. Internal to SystemBuilder.
#include <drev/core/ids.hpp>

#include <deque>
#include <vector>

namespace drev {

class NodeMatrix {
 public:
  /// Adds value at (i, j) and, for i != j, at (j, i).
  void add(int i, int j, double value) {
    if (i != j) return pairs_.push_back({i, j, value});
    if (diagonal_.size() <= idx(i)) diagonal_.resize(idx(i + 1));
    diagonal_[idx(i)] += value;
  }
  /// Calls visit(i, j, factor value) for every entry of both triangles; more than once for some.
  template <class Visit>
  void for_each(double factor, const Visit& visit) const {
    if (factor == 0.0) return;
    for (std::size_t i = 0; i < diagonal_.size(); ++i)
      if (diagonal_[i] != 0.0) visit(static_cast<int>(i), static_cast<int>(i), factor * diagonal_[i]);
    for (const Pair& p : pairs_) {
      visit(p.i, p.j, factor * p.value);
      visit(p.j, p.i, factor * p.value);
    }
  }
  /// Gives its memory back.
  void clear() { *this = NodeMatrix(); }

 private:
  struct Pair {
    int i, j;
    double value;
  };
  std::vector<double> diagonal_;  // 0 beyond its end
  std::deque<Pair> pairs_;        // in pieces: a list that grows moves nothing
};

}  // namespace drev
