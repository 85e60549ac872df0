#pragma once

#include <string_view>

namespace sandglass::build_info {

extern const std::string_view version;   ///< version of the project
extern const std::string_view revision;  ///< git revision, with "+changes" when the tree is not clean
extern const std::string_view compiler;
extern const std::string_view flags;

}  // namespace sandglass::build_info
