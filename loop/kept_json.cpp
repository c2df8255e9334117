// SPDX-License-Identifier: MIT
#include "loop/kept_json.hpp"

#include <fmt/format.h>

#include "notation/errors.hpp"
#include "notation/utf8.hpp"

namespace mixloop {

void KeptJson::refuse(const std::string& key, const nlohmann::ordered_json& found,
                      const std::string& expected) const {
  const std::string text = found.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
  throw InputError(
      "wrong_kind", {file_.string()},
      fmt::format("its '{}' is {}; expected {}, as --out keeps it", key, in_quotes(text), expected));
}

void KeptJson::miss(const std::string& key) const {
  throw InputError("missing_key", {file_.string()},
                   fmt::format("has no '{}'; expected what --out keeps", key));
}

}  // namespace mixloop
