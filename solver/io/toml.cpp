/// The functions of toml++; see toml.hpp.
#define TOML_IMPLEMENTATION
#include "io/toml.hpp"
