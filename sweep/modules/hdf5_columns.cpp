// SPDX-License-Identifier: MIT
// Tables as HDF5: a module of its own, so that nothing else loads what HDF5 loads.
#include <hdf5.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <system_error>
#include <utility>

#include "sweep/column_file.hpp"

namespace mixloop {
namespace {

constexpr hsize_t kRowsAChunk = 8192;

/// What HDF5 hands out, given back with it.
class Handle {
 public:
  Handle(hid_t id, herr_t (*close)(hid_t)) : id_(id), close_(close) {
    if (id < 0) throw std::system_error(errno, std::generic_category());
  }
  ~Handle() {
    if (id_ >= 0) close_(id_);
  }
  Handle(Handle&& other) noexcept : id_(std::exchange(other.id_, -1)), close_(other.close_) {}
  Handle& operator=(Handle&&) = delete;
  operator hid_t() const { return id_; }  // NOLINT(google-explicit-constructor): as HDF5's functions take it

 private:
  hid_t id_;
  herr_t (*close_)(hid_t);
};

void require(herr_t done) {
  if (done < 0) throw std::system_error(errno != 0 ? errno : EIO, std::generic_category());
}

Handle text_type(std::size_t length) {
  Handle type(H5Tcopy(H5T_C_S1), H5Tclose);
  require(H5Tset_size(type, std::max<std::size_t>(length, 1)));
  require(H5Tset_strpad(type, H5T_STR_NULLPAD));
  return type;
}

Handle type_of(const FileColumn& column) {
  switch (column.kind) {
    case FileColumn::Kind::whole:
      return {H5Tcopy(H5T_STD_I64LE), H5Tclose};
    case FileColumn::Kind::number:
      return {H5Tcopy(H5T_IEEE_F64LE), H5Tclose};
    case FileColumn::Kind::text:
      return text_type(column.width);
    case FileColumn::Kind::word:
      break;
  }
  Handle type(H5Tenum_create(H5T_STD_U8LE), H5Tclose);
  std::uint8_t number = 0;
  for (const auto& word : column.words) {
    require(H5Tenum_insert(type, word.c_str(), &number));
    ++number;
  }
  return type;
}

/// A dataset that grows a chunk at a time; its rows are bytes of its type.
class Column {
 public:
  Column(hid_t file, const FileColumn& column, std::int64_t rows)
      : type_(type_of(column)), width_(H5Tget_size(type_)), dataset_(made(file, column.name, rows)) {
    const std::string& unit = column.unit;
    if (unit.empty()) return;
    const Handle of(text_type(unit.size())), scalar(H5Screate(H5S_SCALAR), H5Sclose);
    const Handle attribute(H5Acreate2(dataset_, "unit", of, scalar, H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
    require(H5Awrite(attribute, of, unit.data()));
  }

  void add(std::string_view value) {
    const std::size_t end = rows_.size() + width_;
    rows_ += value.substr(0, width_);
    rows_.resize(end, '\0');
    if (rows_.size() == width_ * kRowsAChunk) flush();
  }
  void flush() {
    hsize_t count = rows_.size() / width_;
    if (count == 0) return;
    const Handle there(H5Dget_space(dataset_), H5Sclose),
        here(H5Screate_simple(1, &count, nullptr), H5Sclose);
    require(H5Sselect_hyperslab(there, H5S_SELECT_SET, &written_, nullptr, &count, nullptr));
    require(H5Dwrite(dataset_, type_, here, there, H5P_DEFAULT, rows_.data()));
    written_ += count;
    rows_.clear();
  }

 private:
  Handle made(hid_t file, const std::string& name, std::int64_t runs) const {
    const auto rows = static_cast<hsize_t>(runs);
    const hsize_t chunk = std::min(rows, kRowsAChunk);
    const Handle space(H5Screate_simple(1, &rows, nullptr), H5Sclose),
        how(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
    require(H5Pset_chunk(how, 1, &chunk));
    require(H5Pset_shuffle(how));
    require(H5Pset_deflate(how, 4));
    require(H5Pset_obj_track_times(how, false));
    return {H5Dcreate2(file, name.c_str(), type_, space, H5P_DEFAULT, how, H5P_DEFAULT), H5Dclose};
  }

  Handle type_;
  std::size_t width_;
  Handle dataset_;
  hsize_t written_ = 0;
  std::string rows_;
};

void write_whole(const std::filesystem::path& file, const std::vector<FileColumn>& columns, std::int64_t rows,
                 const EachRow& each) {
  const Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose), how(H5Pcreate(H5P_FILE_CREATE), H5Pclose);
  require(H5Pset_libver_bounds(access, H5F_LIBVER_V18, H5F_LIBVER_V18));
  require(H5Pset_obj_track_times(how, false));  // equal tables are equal files
  const Handle out(H5Fcreate(file.c_str(), H5F_ACC_TRUNC, how, access), H5Fclose);
  std::vector<Column> all;
  for (const FileColumn& column : columns) all.emplace_back(out, column, rows);
  each([&](std::span<const std::string_view> row) {
    for (std::size_t i = 0; i < all.size(); ++i) all[i].add(row[i]);
  });
  for (Column& column : all) column.flush();
  require(H5Fflush(out, H5F_SCOPE_LOCAL));
}

}  // namespace
}  // namespace mixloop

extern "C" __attribute__((visibility("default"))) void mixloop_write_hdf5(
    const std::filesystem::path& file, const std::vector<mixloop::FileColumn>& columns, std::int64_t rows,
    const mixloop::EachRow& each) {
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
  errno = 0;
  mixloop::write_whole(file, columns, rows, each);
}
