// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace mixloop {

/// A column of a table on its way into a file that modules know how to write.
struct FileColumn {
  enum class Kind : std::uint8_t {
    whole,   ///< std::int64_t
    number,  ///< double
    text,    ///< as it is, up to its width
    word     ///< std::uint8_t, the number of a word
  };
  std::string name, unit;
  Kind kind = Kind::number;
  std::size_t width = 8;           ///< bytes a row
  std::vector<std::string> words;  ///< of a word: those that there are
};

/// Goes over the rows of a table: the bytes of each column.
using EachRow = std::function<void(const std::function<void(std::span<const std::string_view> row)>& told)>;

/// Writes a table of so many rows. Throws std::system_error.
using WriteColumns = void (*)(const std::filesystem::path& file, const std::vector<FileColumn>& columns,
                              std::int64_t rows, const EachRow& each);

/// What a module that knows HDF5 has.
inline constexpr const char* kWriteHdf5Symbol = "mixloop_write_hdf5";

}  // namespace mixloop
