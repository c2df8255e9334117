// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "notation/document.hpp"

namespace mixloop {

struct Keys;

/// What a value is written as, as far as a schema can say.
struct Form {
  enum class Kind { any, text, number, flag, whole, word, list, named, mapping, one_of };

  Kind kind = Kind::text;
  std::vector<std::string> words{};  ///< of a word: those that there are
  std::vector<Form> of{};  ///< of a list: its items; of named ones: the values; else the alternatives
  const Keys& (*keys)() = nullptr;  ///< of a mapping
};

/// One key of a mapping.
struct Key {
  std::string name;
  Form form;
  bool required = false;
};
inline constexpr bool kRequired = true;

/// All keys of one kind of mapping: what its reader takes, and what a schema says of it.
struct Keys {
  std::string what;  ///< for messages, e.g. "the path"
  std::vector<Key> all;
  std::string unless{};               ///< a key beside which none is required; empty: there is no such key
  std::vector<std::string> either{};  ///< one of these is required, and no two stand together
};

/// The mapping as one that has these keys. Throws InputError as Mapping does, and for
/// none of `either` ("missing_key") or several ("doubly_defined").
Mapping read_mapping(NodePtr node, const Keys& keys);

/// The words of a key whose value is one.
const std::vector<std::string>& words_of(const Keys& keys, std::string_view name);

namespace form {

inline Form any() { return {Form::Kind::any}; }
inline Form text() { return {Form::Kind::text}; }
inline Form number() { return {Form::Kind::number}; }  ///< or a formula, with or without a unit
inline Form flag() { return {Form::Kind::flag}; }
inline Form whole() { return {Form::Kind::whole}; }
inline Form word(std::vector<std::string> words) { return {Form::Kind::word, std::move(words)}; }
/// A list; a lone item that is no mapping stands for a list of one.
inline Form list(Form item) { return {Form::Kind::list, {}, {std::move(item)}}; }
inline Form numbers() { return list(number()); }
/// A mapping of names that the file itself gives.
inline Form named(Form value) { return {Form::Kind::named, {}, {std::move(value)}}; }
inline Form mapping(const Keys& (*keys)()) { return {Form::Kind::mapping, {}, {}, keys}; }
inline Form one_of(std::vector<Form> forms) { return {Form::Kind::one_of, {}, std::move(forms)}; }

}  // namespace form

}  // namespace mixloop
