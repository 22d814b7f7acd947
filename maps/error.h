#pragma once
// The typed exception for what a person can mend: a bad file, a bad setting, a bad argument.

#include <stdexcept>
#include <string>

namespace rovigo::maps {

/// A file, setting or argument that cannot be used. The message is one sentence that names what
/// and where, the value, the limit, and the way out. The command line exits with code 2 on it.
class InputError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace rovigo::maps
