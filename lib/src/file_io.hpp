// Files, for the sources of this library only: bounded reading, atomic writing.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include <burin/result.hpp>

namespace burin {

// "cannot open 'path': No such file or directory", for the current errno.
Error file_error(const std::string& what, const std::string& path);

// Calls `write` with the name of a temporary file beside `path`; renames it to `path` when `write` succeeds,
// and removes it otherwise. A target that is no regular file (a device, a pipe) is written directly.
Status write_atomically(const std::string& path, const std::function<Status(const std::string&)>& write);

}  // namespace burin
