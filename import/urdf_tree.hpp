// SPDX-License-Identifier: MIT
#pragma once

#include <map>
#include <string>
#include <vector>

#include "import/xml_file.hpp"

namespace mixloop {

/// The links and joints of a URDF, held together to one tree.
struct UrdfTree {
  using Element = XmlFile::Element;

  std::map<std::string, const Element*> links, joints;
  std::vector<std::string> order;                  ///< of the links: parents first, then as in the file
  std::map<std::string, const Element*> joint_to;  ///< a link's name -> the joint that leads to it
};

/// Throws InputError, with the place: for a root that is no <robot> ("not_urdf"), what lacks a name, a joint
/// that lacks type, parent, child or limits ("missing_key"), names given twice ("doubly_defined"), unknown
/// types ("unknown_value") and links and joints that don't exist ("undefined_symbol"), what is no tree
/// ("not_a_tree"): two parents, two roots, a circle.
UrdfTree tree_of(const XmlFile& file);

/// The value of an attribute that can't be left out; throws InputError("missing_key").
std::string needed(const XmlFile& file, const XmlFile::Element& element, const char* attribute);

}  // namespace mixloop
