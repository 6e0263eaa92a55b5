#pragma once
/// A model file with the files that it includes, taken apart into its sections. Nothing is evaluated yet but
/// the defaults of parameters and the lists.
#include <drev/models/parameters.hpp>

#include <deque>
#include <map>

#include "app/model_file/tree.hpp"

namespace drev::app {

inline constexpr int kFormat = 1;

/// Nodes and elements of one file, or of one [[repeat]]; null where it has none.
struct Block {
  const Value* nodes = nullptr;
  const Value* elements = nullptr;
  const Value* repeat = nullptr;
};

struct Document {
  std::string name, summary, note;
  Position at;  ///< of the file
  std::vector<Parameter> parameters;
  std::map<std::string, std::vector<double>> lists;
  std::map<std::string, const Value*> tables;
  std::vector<Block> blocks;        ///< in the order in which they count: what is included comes first
  const Value* run = nullptr;       ///< [run], that of the main file laid over those included
  const Value* strength = nullptr;  ///< [class], likewise
  std::vector<Finding> findings;
  bool whole = true;             ///< false: nodes or elements may be missing because of a finding
  std::deque<Value> roots = {};  ///< keeps what the pointers above point to

  /// Names of the tables inside [run], which are runs but for its parameters.
  std::vector<std::string> run_names() const;
};

/// `path` is the file's name, with the folder that its includes are relative to. Throws ModelError only where
/// the file is no TOML; all else is in findings.
Document read_document(const std::string& text, const std::string& path);

}  // namespace drev::app
