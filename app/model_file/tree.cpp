#include "app/model_file/tree.hpp"

#include <filesystem>
#include <fstream>
#include <iterator>

namespace drev::app {

std::string Position::text() const {
  return (file ? *file : std::string()) + ":" + std::to_string(line) + ":" + std::to_string(column);
}

const Entry* Value::find(const std::string& key) const {
  for (const Entry& entry : entries)
    if (entry.key == key) return &entry;
  return nullptr;
}

std::string kind_name(const Value& value) {
  switch (value.kind) {
    case Value::Kind::boolean:
      return value.flag ? "true" : "false";
    case Value::Kind::whole:
      return "the number " + std::to_string(value.whole);
    case Value::Kind::number:
      return "the number " + to_text(value.number);
    case Value::Kind::text:
      return "the text \"" + value.text + "\"";
    case Value::Kind::array:
      return "an array";
    case Value::Kind::table:
      return "a table";
    case Value::Kind::other:
      return "a date or time";
  }
  return "";
}

Finding fault_at(const Position& at, const std::string& where, const std::string& sentence) {
  return {at.text(), where, "", "", sentence};
}

std::string read_text(const std::string& path, const Position* at) {
  const auto refuse = [&](const std::string& why) {
    if (at != nullptr) throw ModelError({fault_at(*at, path, why)});
    throw ModelError({{path, "", "", "", why}});
  };
  std::error_code error;
  const auto status = std::filesystem::status(path, error);
  if (!std::filesystem::exists(status)) refuse("there is no such file");
  if (!std::filesystem::is_regular_file(status)) refuse("is no regular file");
  if (std::filesystem::file_size(path, error) > kLargestFile)
    refuse("is larger than " + std::to_string(kLargestFile >> 20) + " MiB");
  try {
    std::ifstream file(path, std::ios::binary);
    std::string text{std::istreambuf_iterator<char>(file), {}};
    if (file) return text;
  } catch (const std::ios_base::failure&) {  // the library's own, where reading itself fails
  }
  refuse("cannot be read");
  return {};
}

}  // namespace drev::app
