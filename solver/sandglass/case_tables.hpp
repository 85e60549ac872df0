#pragma once

#include <string>
#include <vector>

#include "io/mesh_file.hpp"

namespace sandglass {

/// A key of a table, as declared by the type that holds its value.
struct CaseKey {
  std::string name;
  std::string type;     ///< "number", "integer", "text", "flag", "word" or "table"
  int count = 1;        ///< entries of a list of fixed length; 0: a list of any length; 1: no list
  std::string unit;     ///< "-" if there is none
  std::string allowed;  ///< an interval, or words separated by ", "
  bool required = true;
  std::string standard;  ///< the default, if it is a number, a flag or a word
  std::string meaning;
};

/// A table of a case file, or one choice of a table whose keys depend on it, such as a law of [material].
struct CaseTable {
  std::string table;
  bool several = false;         ///< [[table]], else [table]
  std::string choice_key = {};  ///< such as "law"; empty if the keys do not depend on a choice
  std::string choice = {};      ///< such as "neo-hookean"
  std::string summary;
  std::vector<CaseKey> keys;
};

/// The tables of a case file, for programs that write cases: mesh generators, laws, imposed motions, forces
/// and settings. Laws, generators and kinds of forces come from their lists.
std::vector<CaseTable> case_tables();

/// The mesh of a table [mesh], given as the lines of its keys, and its sets. Paths are relative to the
/// current folder. Throws InputError.
MeshWithSets mesh_of_keys(const std::string& keys);

}  // namespace sandglass
