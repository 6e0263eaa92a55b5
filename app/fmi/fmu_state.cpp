#include "app/fmi/fmu_state.hpp"

#include <cstring>
#include <stdexcept>

namespace drev::app {

namespace {

constexpr const char* kHead = "drev FMU state 2";

/// One list of fields serves for writing and reading. Sizes are checked against the bytes left before memory
/// is allocated.
class Writer {
 public:
  template <class T>
  void plain(const T& value) {
    const auto* first = reinterpret_cast<const std::uint8_t*>(&value);
    bytes.insert(bytes.end(), first, first + sizeof value);
  }
  template <class List>
  void size(const List& list) {
    plain(static_cast<std::uint64_t>(list.size()));
  }
  std::vector<std::uint8_t> bytes;
};

class Reader {
 public:
  Reader(const std::uint8_t* bytes, std::size_t size) : next_(bytes), left_(size) {}
  template <class T>
  void plain(T& value) {
    if (left_ < sizeof value) throw std::invalid_argument("the bytes end too early");
    std::memcpy(&value, next_, sizeof value);
    next_ += sizeof value;
    left_ -= sizeof value;
  }
  template <class List>
  void size(List& list) {
    std::uint64_t count = 0;
    plain(count);
    if (count > left_) throw std::invalid_argument("a list is longer than the bytes");
    list.resize(static_cast<decltype(list.size())>(count));
  }
  void finish() const {
    if (left_ != 0) throw std::invalid_argument("there are more bytes than a state has");
  }

 private:
  const std::uint8_t* next_;
  std::size_t left_;
};

/// A flag as a byte, since not every byte value is a valid bool.
void flag_field(Writer& writer, bool flag) { writer.plain(static_cast<std::uint8_t>(flag)); }
void flag_field(Reader& reader, bool& flag) {
  std::uint8_t byte = 0;
  reader.plain(byte);
  if (byte > 1) throw std::invalid_argument("the bytes are no state");
  flag = byte == 1;
}

void optional_field(Writer& writer, const std::optional<double>& value) {
  flag_field(writer, value.has_value());
  writer.plain(value.value_or(0.0));
}
void optional_field(Reader& reader, std::optional<double>& value) {
  bool there = false;
  flag_field(reader, there);
  reader.plain(value.emplace());
  if (!there) value.reset();
}

template <class Stream, class Text>
void text_field(Stream& stream, Text& text) {
  stream.size(text);
  for (auto& c : text) stream.plain(c);
}

template <class Stream, class VectorType>
void vector_field(Stream& stream, VectorType& vector) {
  stream.size(vector);
  for (Eigen::Index i = 0; i < vector.size(); ++i) stream.plain(vector[i]);
}

template <class Stream, class Signal>
void signal_fields(Stream& stream, Signal& signal) {
  stream.plain(signal.t_0);
  stream.plain(signal.value);
  stream.plain(signal.slope);
}

template <class Stream, class StateType>
void fields(Stream& stream, StateType& s) {
  stream.plain(s.mode);
  flag_field(stream, s.started);
  stream.plain(s.t_start);
  optional_field(stream, s.t_stop);
  stream.plain(s.tolerance);
  stream.size(s.parameters);
  for (auto& text : s.parameters) text_field(stream, text);
  for (auto* values : {&s.torque_values, &s.speed_values}) {
    stream.size(*values);
    for (auto& input : *values) {
      stream.plain(input.value);
      stream.plain(input.slope);
    }
  }
  stream.size(s.torques);
  for (auto& torque : s.torques) signal_fields(stream, torque);
  stream.size(s.speeds);
  for (auto& speed : s.speeds) {
    signal_fields(stream, speed.signal);
    stream.plain(speed.deviation);
  }
  stream.plain(s.state.t);
  vector_field(stream, s.state.z);
  vector_field(stream, s.state.v);
  vector_field(stream, s.state.a);
  vector_field(stream, s.state.history);
}

}  // namespace

std::vector<std::uint8_t> to_bytes(const FmuState& state, const std::string& token) {
  Writer writer;
  text_field(writer, std::as_const(token));
  const std::string head = kHead;
  text_field(writer, head);
  fields(writer, state);
  return std::move(writer.bytes);
}

FmuState from_bytes(const std::uint8_t* bytes, std::size_t size, const std::string& token) {
  Reader reader(bytes, size);
  std::string of, head;
  text_field(reader, of);
  if (of != token) throw std::invalid_argument("the bytes are of another FMU");
  text_field(reader, head);
  if (head != kHead) throw std::invalid_argument("the bytes are of another version of drev");
  FmuState state;
  fields(reader, state);
  reader.finish();
  if (state.mode > FmuMode::terminated) throw std::invalid_argument("the bytes are no state");
  return state;
}

}  // namespace drev::app
