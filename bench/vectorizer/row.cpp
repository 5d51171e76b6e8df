#include "row.hpp"

#include <algorithm>
#include <cstdarg>
#include <cstdio>

#include "patterns.hpp"

namespace burin::bench {
namespace {

constexpr double kRawBytes = double(kPatternTexels) * kPatternTexels;  // of the map, 8 bit

// What a row is judged by. Each figure is to be at most its bound.
struct Figure {
    const char* name;
    double value, bound;
    bool met() const { return value <= bound; }
};

enum { kContour, kContour999, kHeight, kMissing, kSize, kTwice, kFigures };

std::vector<Figure> figures_of(const Row& row) {
    const bool jpeg = row.damage == Damage::jpeg, soft = row.wall > 1.0;
    constexpr double kNone = 1e300;
    std::vector<Figure> figures(kFigures);
    figures[kContour] = {"contour RMS", row.contour.rms, soft ? (jpeg ? 0.015 : 0.005) : (jpeg ? 0.02 : 0.01)};
    figures[kContour999] = {"contour 99.9 %", row.contour.p999, jpeg ? 0.15 : 0.05};
    figures[kHeight] = {"height / bilinear", row.height / row.bilinear, soft ? kNone : (jpeg ? 0.2 : 0.1)};
    figures[kMissing] = {"structure missed %", 100.0 - row.structure.percent(), 5.0};
    // JPEG is no clean map: its size is shown and not judged.
    figures[kSize] = {"bytes / raw", static_cast<double>(row.texture_bytes) / kRawBytes, jpeg ? kNone : 1.0 / 40.0};
    figures[kTwice] = {"height / bilinear at twice", row.height / row.bilinear_twice, jpeg ? kNone : 1.0};
    return figures;
}

std::string formatted(const char* form, ...) __attribute__((format(printf, 1, 2)));
std::string formatted(const char* form, ...) {
    char text[256];
    va_list values;
    va_start(values, form);
    std::vsnprintf(text, sizeof text, form, values);
    va_end(values);
    return text;
}

std::string marked(const std::string& text, const Figure& figure) { return figure.met() ? text : text + " !"; }

std::string tally(const Tally& t) { return formatted("%d/%d/%d", t.authored, t.recovered, t.matched); }

void print_details(const Row& row, const Details& details) {
    static const char* const kKinds[kNodeKinds] = {"end", "corner", "tee", "crossing", "wye", "star"};
    for (std::size_t i = 0; i < row.contour.spots.size() && i < static_cast<std::size_t>(details.spots); ++i)
        std::printf("    %.0f, %.0f: %.1f %% of the mean square\n", row.contour.spots[i].corner.x, row.contour.spots[i].corner.y,
                    100.0 * row.contour.spots[i].share);
    for (const Miss& miss : row.structure.misses)
        if (details.misses)
            std::printf("    %s %s at %.1f, %.1f\n", miss.authored ? "missed" : "false", miss.path ? "path" : kKinds[static_cast<int>(miss.kind)],
                        miss.place.x, miss.place.y);
}

double median(std::vector<double> values) {
    std::nth_element(values.begin(), values.begin() + values.size() / 2, values.end());
    return values[values.size() / 2];
}

void print_group(const std::vector<Row>& rows) {
    std::printf("| %s | %s |", text_of(rows.front().wall).c_str(), name_of(rows.front().damage));
    int all = 0;
    for (const Row& row : rows) {
        const auto figures = figures_of(row);
        all += std::all_of(figures.begin(), figures.end(), [](const Figure& f) { return f.met(); }) ? 1 : 0;
    }
    for (int k = 0; k < kFigures; ++k) {
        std::vector<double> values;
        const Row* worst = &rows.front();
        int met = 0;
        for (const Row& row : rows) {
            const Figure figure = figures_of(row)[k];
            values.push_back(figure.value);
            met += figure.met() ? 1 : 0;
            if (figure.value > figures_of(*worst)[k].value) worst = &row;
        }
        const Figure figure = figures_of(*worst)[k];
        const std::string bound = figure.bound < 1e299 ? formatted("%d/%zu", met, rows.size()) : "-";
        std::printf(" %.4g, %.4g (%s), %s |", median(values), figure.value, worst->subject.c_str(), bound.c_str());
    }
    std::printf(" %d/%zu |\n", all, rows.size());
}

}  // namespace

const char* name_of(Damage damage) {
    switch (damage) {
        case Damage::sixteen_bit: return "16";
        case Damage::eight_bit: return "8";
        case Damage::jpeg: return "jpeg";
    }
    return "";
}

std::string text_of(double wall) { return formatted("%g", wall); }

void print_head() {
    std::printf("Structure as authored/recovered/matched; corners, tees, crossings, wyes and stars are the junctions.\n\n"
                "| pattern | walls | bits | contour RMS | 99.9 %% | max | lost | height/bilinear | /bilinear at twice | paths | ends | "
                "corners | tees | crossings | wyes | stars | structure | explained | bytes | raw/bytes | elements | CPU s | worst at |\n"
                "|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|\n");
    std::fflush(stdout);
}

void print_row(const Row& row, const Details& details) {
    const std::vector<Figure> f = figures_of(row);
    std::printf("| %s | %s | %s | %s | %s | %.2f | %.2f %% | %s | %s |", row.subject.c_str(), text_of(row.wall).c_str(),
                name_of(row.damage), marked(formatted("%.4f", row.contour.rms), f[kContour]).c_str(),
                marked(formatted("%.3f", row.contour.p999), f[kContour999]).c_str(), row.contour.max, 100.0 * row.contour.lost,
                marked(formatted("%.3f", f[kHeight].value), f[kHeight]).c_str(),
                marked(formatted("%.3f", f[kTwice].value), f[kTwice]).c_str());
    std::printf(" %s |", tally(row.structure.paths).c_str());
    for (const Tally& t : row.structure.nodes) std::printf(" %s |", tally(t).c_str());
    std::printf(" %s | %.4f | %zu | %s | %zu | %.1f | %.0f, %.0f |\n",
                marked(formatted("%.0f %%", row.structure.percent()), f[kMissing]).c_str(), row.explained, row.texture_bytes,
                marked(formatted("%.0f", 1.0 / f[kSize].value), f[kSize]).c_str(), row.elements, row.seconds, row.worst.x,
                row.worst.y);
    print_details(row, details);
}

void print_summary(const std::vector<Row>& rows) {
    std::printf("\nEach: median, worst (where), patterns that reach the figure.\n\n| walls | bits |");
    if (rows.empty()) return;
    for (const Figure& figure : figures_of(rows.front())) std::printf(" %s |", figure.name);
    std::printf(" all |\n|---|---|---|---|---|---|---|---|---|\n");
    for (const double wall : {2.0, 0.4}) {
        for (const Damage damage : {Damage::sixteen_bit, Damage::eight_bit, Damage::jpeg}) {
            std::vector<Row> group;
            std::copy_if(rows.begin(), rows.end(), std::back_inserter(group),
                         [&](const Row& row) { return row.wall == wall && row.damage == damage; });
            if (!group.empty()) print_group(group);
        }
    }
}

}  // namespace burin::bench
