#pragma once

// The types that a netCDF-4 file defines for itself: enumerations, compounds, lists and opaque ones.

#include <map>

namespace thin {

// Defines the types of one file in another, and knows each by its number in the first.
class NetcdfTypes {
 public:
  // Those of one group, in their order. Parents come first. Returns netCDF's error code, 0 for none.
  int copy_group(int from, int to);

  // The number in the new file. REQUIRES: copy_group was called for the group that defines the type
  int of(int type) const;

 private:
  int copy_type(int from, int type, int to);
  int copy_enumeration(int from, int type, int to);
  int copy_compound(int from, int type, int to);

  std::map<int, int> types_;
};

}  // namespace thin
