#include "solvers/periodic/lane_sections.hpp"

namespace drev {

namespace {

DREV_WIDEST void row_sums(int rows, const int* begin, const int* index, const double* coeff, const LaneRow* z,
                          LaneRow* sums) {
  for (int r = 0; r < rows; ++r) {
    Lanes sum{};
    for (int e = begin[r]; e < begin[r + 1]; ++e) sum += coeff[e] * z[index[e]].v;
    sums[r].v = sum;
  }
}

template <class Value>
[[gnu::always_inline]] inline void powers(int n, const int* outer, const int* inner, const Value* damping,
                                          const Lanes& w, const LaneRow* p_re, const LaneRow* p_im,
                                          const LaneRow* re, const LaneRow* im, Lanes& input,
                                          Lanes& dissipated) {
  Lanes in{}, lost{};
  for (int j = 0; j < n; ++j) {
    in += re[j].v * p_im[j].v - im[j].v * p_re[j].v;
    Lanes force_re{}, force_im{};
    for (int e = outer[j]; e < outer[j + 1]; ++e) {
      force_re += each(damping[e]) * re[inner[e]].v;
      force_im += each(damping[e]) * im[inner[e]].v;
    }
    lost += re[j].v * force_re + im[j].v * force_im;
  }
  input = 0.5 * w * in;
  dissipated = 0.5 * w * w * lost;
}

DREV_WIDEST void powers_common(int n, const int* outer, const int* inner, const double* damping,
                               const Lanes& w, const LaneRow* p_re, const LaneRow* p_im, const LaneRow* re,
                               const LaneRow* im, Lanes& input, Lanes& dissipated) {
  powers(n, outer, inner, damping, w, p_re, p_im, re, im, input, dissipated);
}
DREV_WIDEST void powers_each(int n, const int* outer, const int* inner, const LaneRow* damping,
                             const Lanes& w, const LaneRow* p_re, const LaneRow* p_im, const LaneRow* re,
                             const LaneRow* im, Lanes& input, Lanes& dissipated) {
  powers(n, outer, inner, damping, w, p_re, p_im, re, im, input, dissipated);
}

}  // namespace

LaneSections::LaneSections(const System& system, const std::vector<SectionRows>& sections) {
  begin_.push_back(0);
  const auto add = [this](const std::vector<Entry>& row) {
    for (const Entry& e : row) {
      index_.push_back(e.index);
      coeff_.push_back(e.coeff);
    }
    begin_.push_back(static_cast<int>(index_.size()));
  };
  for (const SectionRows& s : sections) {
    add(s.stiffness);
    add(s.damping);
    add(s.twist);
    add(s.damper);
    add(s.frequency_term < 0 ? std::vector<Entry>{} : system.frequency_terms()[idx(s.frequency_term)].z);
  }
  re_.resize(begin_.size() - 1);
  im_.resize(begin_.size() - 1);
}

void LaneSections::find(const LaneArray& re, const LaneArray& im) {
  const auto rows = static_cast<int>(re_.size());
  row_sums(rows, begin_.data(), index_.data(), coeff_.data(), re.data(), re_.data());
  row_sums(rows, begin_.data(), index_.data(), coeff_.data(), im.data(), im_.data());
}

void lane_powers(const SparseMatrix& pattern, const double* damping, const Lanes& w, const LaneArray& p_re,
                 const LaneArray& p_im, const LaneArray& re, const LaneArray& im, Lanes& input,
                 Lanes& dissipated) {
  powers_common(static_cast<int>(pattern.cols()), pattern.outerIndexPtr(), pattern.innerIndexPtr(), damping,
                w, p_re.data(), p_im.data(), re.data(), im.data(), input, dissipated);
}

void lane_powers(const SparseMatrix& pattern, const LaneRow* damping, const Lanes& w, const LaneArray& p_re,
                 const LaneArray& p_im, const LaneArray& re, const LaneArray& im, Lanes& input,
                 Lanes& dissipated) {
  powers_each(static_cast<int>(pattern.cols()), pattern.outerIndexPtr(), pattern.innerIndexPtr(), damping, w,
              p_re.data(), p_im.data(), re.data(), im.data(), input, dissipated);
}

}  // namespace drev
