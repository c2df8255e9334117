// SPDX-License-Identifier: MIT
#include <fmt/format.h>
#include <hdf5.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

#include "notation/errors.hpp"
#include "notation/long_work.hpp"
#include "sweep/table.hpp"

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

Handle end_type() {
  Handle type(H5Tenum_create(H5T_STD_U8LE), H5Tclose);
  for (std::uint8_t i = 0; i < kRunEnds; ++i)
    require(H5Tenum_insert(type, name_of(static_cast<RunEnd>(i)).data(), &i));
  return type;
}

/// A dataset that grows a chunk at a time; its rows are bytes of its type.
class Column {
 public:
  Column(hid_t file, const std::string& name, const std::string& unit, Handle type, std::int64_t runs)
      : type_(std::move(type)), width_(H5Tget_size(type_)), dataset_(made(file, name, runs)) {
    if (unit.empty() || unit == "1") return;
    const Handle of(text_type(unit.size())), scalar(H5Screate(H5S_SCALAR), H5Sclose);
    const Handle attribute(H5Acreate2(dataset_, "unit", of, scalar, H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
    require(H5Awrite(attribute, of, unit.data()));
  }

  void add(const void* value, std::size_t size) {
    const std::size_t at = rows_.size();
    rows_.resize(at + width_, '\0');
    std::memcpy(rows_.data() + at, value, std::min(size, width_));
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

/// The columns in the order of a row.
class Table {
 public:
  Table(hid_t file, const Sweep& sweep) : sweep_(sweep) {
    const auto add = [&](const std::string& name, const std::string& unit, Handle type) {
      columns_.emplace_back(file, name, unit, std::move(type), sweep.runs());
    };
    const auto number = [] { return Handle(H5Tcopy(H5T_IEEE_F64LE), H5Tclose); };
    add("run", "", Handle(H5Tcopy(H5T_STD_I64LE), H5Tclose));
    for (const Variation& one : sweep.setup().design().variations()) {
      std::size_t longest = 0;
      for (const auto& text : one.texts) longest = std::max(longest, text.size());
      add(one.key, one.unit, one.is_number() ? number() : text_type(longest));
    }
    add("end", "", end_type());
    for (const auto& column : sweep.telling().columns.all()) add(column.name, column.unit, number());
    if (sweep.telling().hashes) add("trajectory_sha256", "", text_type(64));
    add("error", "", text_type(32));
  }

  void add(const Outcome& outcome) {
    auto column = columns_.begin();
    (column++)->add(&outcome.run, sizeof outcome.run);
    const Design& design = sweep_.setup().design();
    const auto values = design.values(outcome.run);
    for (std::size_t i = 0; i < values.size(); ++i, ++column)
      if (design.variations()[i].is_number())
        column->add(&values[i].number, sizeof(double));
      else
        column->add(values[i].text.data(), values[i].text.size());
    (column++)->add(&outcome.end, sizeof outcome.end);
    for (const double value : outcome.values) (column++)->add(&value, sizeof value);
    if (sweep_.telling().hashes) (column++)->add(outcome.sha256.data(), outcome.sha256.size());
    column->add(outcome.code.data(), outcome.code.size());
  }
  void flush() {
    for (Column& column : columns_) column.flush();
  }

 private:
  const Sweep& sweep_;
  std::vector<Column> columns_;
};

void write_whole(const std::filesystem::path& file, const Sweep& sweep, const EachRun& each) {
  const Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
  require(H5Pset_libver_bounds(access, H5F_LIBVER_V18, H5F_LIBVER_V18));
  const Handle how(H5Pcreate(H5P_FILE_CREATE), H5Pclose);
  require(H5Pset_obj_track_times(how, false));  // equal tables are equal files
  Handle out(H5Fcreate(file.c_str(), H5F_ACC_TRUNC, how, access), H5Fclose);
  Table table(out, sweep);
  each([&](const Outcome& outcome) {
    table.add(outcome);
    work_goes_on("writing the table", outcome.run, sweep.runs());
  });
  table.flush();
  require(H5Fflush(out, H5F_SCOPE_LOCAL));
}

}  // namespace

bool has_hdf5() { return true; }

void write_hdf5(const std::filesystem::path& file, const Sweep& sweep, const EachRun& each) {
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
  const std::filesystem::path part = file.string() + ".part";
  try {
    errno = 0;
    write_whole(part, sweep, each);
    std::filesystem::rename(part, file);
  } catch (const std::system_error& error) {
    std::error_code ignored;
    std::filesystem::remove(part, ignored);
    throw RunFault("cannot_write", "cannot write " + file.string() + ": " + error.code().message());
  }
}

}  // namespace mixloop
