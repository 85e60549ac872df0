#pragma once

#include <algorithm>
#include <string>
#include <string_view>

namespace sandglass {

/// The greatest width of printed tables and texts.
inline constexpr std::size_t columns_of_text = 100;

/// A text broken between words into lines of at most `width` columns; all but the first are indented.
inline std::string wrapped(std::string_view text, std::size_t indent = 2,
                           std::size_t width = columns_of_text) {
  std::string lines;
  std::size_t column = 0;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find_first_of(" \n", begin), text.size());
    const std::string_view word = text.substr(begin, end - begin);
    const bool ended = begin > 0 && text[begin - 1] == '\n';
    if (ended || (column > indent && column + 1 + word.size() > width)) {
      lines += '\n' + std::string(indent, ' ');
      column = indent;
    } else if (begin > 0) {
      lines += ' ';
      ++column;
    }
    lines += word;
    column += word.size();
    begin = end + 1;
  }
  return lines;
}

}  // namespace sandglass
