// The report: one page that shows what became of a map.
//
//     HeightMap + FoundPattern + reconstruction --[write_html_report]--> text of an HTML file
//
// For people who look rather than read: map, reconstruction, error and paths side by side, close-ups of the places that
// err most, how well the cross-sections fit, and the figures. The page is whole in itself: pictures are PNG within it,
// paths are drawn as SVG, there is no script and nothing is loaded.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include <burin/convert.hpp>
#include <burin/heightmap.hpp>
#include <burin/result.hpp>

namespace burin {

// What the page says besides what it shows. Any text: it is escaped.
struct ReportText {
    std::string title;    // name of the map
    std::string command;  // the command line
    std::string version;  // of the program
    std::vector<std::pair<std::string, std::string>> figures;  // rows of the table: name, value
    std::vector<std::string> notes;                            // what a user should know
};

// Requires (asserted): a reconstruction of the map's size, from `found`. Pictures of the whole map are at most 1024
// texels wide and high: means of the map's texels, and of the error the largest, so that no fine line is lost. Close-ups,
// eight at most, do not overlap; the one that errs most comes first.
// Ensures: equal input gives equal bytes, whatever the number of threads.
// Fails as reconstruct_heights. Cost: below a second for 1024 x 1024; about a megabyte.
// `residual`: of a conversion; it is shown, with the angles of the normals.
Result<std::string> write_html_report(const HeightMap& map, const FoundPattern& found, const Image& reconstruction,
                                      const ReportText& text, const Residual* residual = nullptr, int threads = 0);

}  // namespace burin
