// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace mixloop {

/// An object of JSON that --out kept, where anyone may have written since: an entry is what is asked for, or
/// an error with file and key.
class KeptJson {
 public:
  KeptJson(const nlohmann::ordered_json& object, std::filesystem::path file)
      : object_(object), file_(std::move(file)) {}

  /// The entry as a T (double, std::int64_t, std::string, a std::map<std::string, T> or std::vector<T> of
  /// them, or nlohmann::ordered_json: whatever it is); `otherwise` where there is none. Throws
  /// InputError("wrong_kind").
  template <class T>
  T value(const std::string& key, T otherwise) const {
    const auto at = object_.find(key);
    if (at == object_.end()) return otherwise;
    const Kind<T> kind;
    if (!kind.is(*at)) refuse(key, *at, kind.name);
    return at->template get<T>();
  }
  /// An entry that must be there. Throws InputError("missing_key") too.
  template <class T>
  T value(const std::string& key) const {
    if (!object_.contains(key)) miss(key);
    return value(key, T());
  }

 private:
  template <class T>
  struct Kind;
  [[noreturn]] void refuse(const std::string& key, const nlohmann::ordered_json& found,
                           const std::string& expected) const;
  [[noreturn]] void miss(const std::string& key) const;

  const nlohmann::ordered_json& object_;
  const std::filesystem::path file_;
};

template <>
struct KeptJson::Kind<double> {
  std::string name = "a number";
  static bool is(const nlohmann::ordered_json& json) { return json.is_number(); }
};
template <>
struct KeptJson::Kind<std::int64_t> {
  std::string name = "a whole number";
  static bool is(const nlohmann::ordered_json& json) { return json.is_number_integer(); }
};
template <>
struct KeptJson::Kind<std::string> {
  std::string name = "a text";
  static bool is(const nlohmann::ordered_json& json) { return json.is_string(); }
};
template <class T>
struct KeptJson::Kind<std::vector<T>> {
  std::string name = "a list, each of it " + Kind<T>().name;
  static bool is(const nlohmann::ordered_json& json) {
    return json.is_array() && std::all_of(json.begin(), json.end(), Kind<T>::is);
  }
};
template <class T>
struct KeptJson::Kind<std::map<std::string, T>> {
  std::string name = "a group of entries, each " + Kind<T>().name;
  static bool is(const nlohmann::ordered_json& json) {
    return json.is_object() && std::all_of(json.begin(), json.end(), Kind<T>::is);
  }
};
template <>
struct KeptJson::Kind<nlohmann::ordered_json> {
  std::string name = "of any kind";
  static bool is(const nlohmann::ordered_json&) { return true; }
};

}  // namespace mixloop
