// The stage in order. Each step is a file of its own; resolve_internal.hpp lists them.
#include <burin/resolve.hpp>

#include <algorithm>

#include "resolve_internal.hpp"

namespace burin {
namespace {

using namespace resolving;

// Takes the paths named in errors out; those that ended on them may be in error then, so the caller starts
// again.
std::vector<WorkPath> without(std::vector<WorkPath> paths, const std::vector<PathError>& errors) {
    std::vector<std::uint32_t> bad;
    for (const PathError& error : errors) bad.push_back(static_cast<std::uint32_t>(error.path));
    std::sort(bad.begin(), bad.end());
    std::vector<WorkPath> kept;
    for (WorkPath& path : paths)
        if (!std::binary_search(bad.begin(), bad.end(), path.source)) kept.push_back(std::move(path));
    return kept;
}

// Errors name paths by their place in `work`; from here on by their place in the pattern, each once.
void name_by_source(const Work& work, std::vector<PathError>& errors) {
    for (PathError& error : errors) error.path = work.paths[error.path].source;
    std::stable_sort(errors.begin(), errors.end(),
                     [](const PathError& a, const PathError& b) { return a.path < b.path; });
    errors.erase(std::unique(errors.begin(), errors.end(),
                             [](const PathError& a, const PathError& b) { return a.path == b.path; }),
                 errors.end());
}

// Connects and splits; when lenient, again without the paths in error until none is left.
Status connect(Work& work) {
    const std::vector<WorkPath> clean = work.paths;
    const ResolveStats before = work.stats;
    std::vector<WorkPath> paths = clean;
    for (;;) {
        ResolveStats stats = before;
        stats.dropped_paths = work.stats.dropped_paths;
        stats.first_dropped = std::move(work.stats.first_dropped);
        stats.crossings = std::move(work.stats.crossings);
        work.stats = std::move(stats);
        work.paths = paths;
        work.junctions.clear();
        std::vector<PathError> errors = connect_ends(work);
        if (errors.empty()) errors = split_at_steps(work);
        if (errors.empty()) return Done{};
        name_by_source(work, errors);
        for (const PathError& error : errors)
            if (!tolerate(work, error.message)) return Error{ErrorCode::invalid_input, error.message};
        paths = without(std::move(paths), errors);
    }
}

}  // namespace

Result<ResolvedPattern> resolve_pattern(const Pattern& pattern, const ResolveOptions& options) {
    Work work{.pattern = pattern, .options = options};
    if (const Status status = prepare(work); !status.ok()) return status.error();
    if (const Status status = connect(work); !status.ok()) return status.error();
    find_levels(work);
    find_priorities(work);
    return assemble(work);
}

}  // namespace burin
