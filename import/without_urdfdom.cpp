// SPDX-License-Identifier: MIT
#include "import/import_urdf.hpp"

namespace mixloop {

Imported import_urdf(const std::string&, const std::string&, const ImportOptions&) {
  throw RunFault(
      "missing_part",
      "this mixloop was built without urdfdom, which reads URDF: apt-get install liburdfdom-dev, then "
      "build again");
}

Imported import_urdf_file(const std::string& file, const ImportOptions& options) {
  return import_urdf("", file, options);
}

}  // namespace mixloop
