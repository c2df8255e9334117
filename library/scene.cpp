// SPDX-License-Identifier: MIT
#include "library/inside.hpp"
#include "notation/sha256.hpp"

namespace mixloop::v1 {
namespace {

template <class List>
std::vector<std::string> names_of(const List& list) {
  std::vector<std::string> names;
  for (const auto& item : list) names.push_back(item.name);
  return names;
}

}  // namespace

Scene::Scene(std::shared_ptr<const Content> content) : content_(std::move(content)) {}

Scene Scene::load(const std::string& file, const std::vector<std::string>& sets) {
  return inside::translated([&] {
    return Inside::of(std::make_shared<const mixloop::Scene>(load_scene(file, inside::overrides(sets))));
  });
}

Scene Scene::parse(std::string_view text, const std::string& name, const std::vector<std::string>& sets) {
  return inside::translated([&] {
    return Inside::of(std::make_shared<const mixloop::Scene>(
        load_scene(parse_document(text, name), inside::overrides(sets))));
  });
}

const std::string& Scene::name() const { return content_->scene->name; }
int Scene::n() const { return content_->scene->n(); }
int Scene::n_u() const { return content_->scene->n_u(); }
int Scene::m() const { return content_->scene->m(); }
std::vector<std::string> Scene::independent() const { return names_of(content_->scene->independent); }
std::vector<std::string> Scene::dependent() const { return names_of(content_->scene->coordinates); }

std::vector<Scene::Parameter> Scene::parameters() const {
  std::vector<Parameter> result;
  for (const auto& parameter : content_->scene->parameters)
    result.push_back({parameter.name, parameter.value});
  return result;
}

std::vector<double> Scene::home() const { return content_->scene->home; }
std::vector<std::string> Scene::warnings() const { return content_->scene->warnings; }
std::string Scene::sha256() const { return sha256_hex(content_->scene->canonical); }

}  // namespace mixloop::v1
