#include "pattern_file.hpp"

#include "options.hpp"

namespace burin::cli {

Result<PatternFile> read_pattern_file(const std::string& path, const Arguments&) {
    return Error{ErrorCode::unsupported, "'" + path + "' is no drawing that is known; an SVG file or a pattern in JSON works"};
}

}  // namespace burin::cli
