#include "report.hpp"

#include <algorithm>
#include <cmath>

#include <cpp/prefilter.hpp>

namespace burin::rivals {
namespace {

std::string text_of(const RivalSettings& settings) {
    std::string text = settings.technique == Technique::normals ? "" : std::to_string(settings.steps) + " steps, ";
    if (settings.technique == Technique::triangles) text = "";
    return std::to_string(settings.size) + "², " + text + std::to_string(settings.samples) + (settings.places == Places::grid ? "" : "h") +
           (settings.wide_heights ? ", 16 bits" : "");
}

std::string number_of(double value) {
    if (value > 1e299) return "unreached";
    char text[32];
    std::snprintf(text, sizeof text, value < 100.0 ? "%.2f" : "%.0f", value);
    return text;
}

// "-" of no values.
std::string median_of(std::vector<double> values) {
    if (values.empty()) return "-";
    std::sort(values.begin(), values.end());
    return number_of(values[values.size() / 2]);
}

std::string least_of(const std::vector<double>& values) { return values.empty() ? "-" : number_of(*std::min_element(values.begin(), values.end())); }

const char* kind_of(bool grooves) { return grooves ? "grooves" : "ridges and CSG"; }

void print_json(std::FILE* file, const ViewResult& result, const char* technique, const std::string& setting, const RivalSettings* rival,
                const Trial& trial, double plain, double blocks) {
    std::fprintf(file, "{\"scene\": \"%s\", \"view\": \"%s\", \"kind\": \"%s\", \"technique\": \"%s\", \"setting\": \"%s\", ",
                 result.scene.c_str(), result.view.c_str(), kind_of(result.grooves), technique, setting.c_str());
    if (rival != nullptr)
        std::fprintf(file, "\"size\": %d, \"samples\": %d, \"steps\": %d, \"places\": \"%s\", \"bias\": %g, ", rival->size,
                     rival->samples, rival->steps, rival->places == Places::grid ? "grid" : "hammersley", double(rival->bias));
    std::fprintf(file, "\"ms\": %.3f, \"dB\": %.2f, \"bytes\": %.0f, \"block_bytes\": %.0f}\n", trial.milliseconds, trial.decibels, plain, blocks);
}

// Of the techniques that reach an error the fastest; null where none does.
const TechniqueResult* fastest(const std::vector<TechniqueResult>& techniques, Found TechniqueResult::*at) {
    const TechniqueResult* found = nullptr;
    for (const TechniqueResult& one : techniques)
        if ((one.*at).reached && (found == nullptr || (one.*at).best.trial.milliseconds < (found->*at).best.trial.milliseconds)) found = &one;
    return found;
}

}  // namespace

BurinBytes burin_bytes(const testing::PreparedPattern& prepared) {
    const double stored = 4.0 * double(prepared.textures.grid.size() + prepared.textures.data.size());
    const Prefilter filter = prefilter_pattern(prepared.textures, prepared.detail);
    const double layers = std::ceil(double(filter.classes.size()) / 4.0);
    return {stored, stored + layers * filter.columns * filter.rows * 8.0 * 4.0 / 3.0};
}

bool holds_grooves_only(const ResolvedPattern& pattern) {
    for (const Style& style : pattern.styles) {
        const auto& points = pattern.profiles[style.profile].points;
        if (style.step) return false;
        for (std::size_t i = 0; i < points.size(); ++i)
            if (points[i].h > 0.0 || (i > 0 && points[i].b < points[i - 1].b)) return false;
    }
    return true;
}

const TechniqueResult* ViewResult::best() const { return fastest(techniques, &TechniqueResult::equal); }

const TechniqueResult* ViewResult::nearest() const {
    return &*std::max_element(techniques.begin(), techniques.end(), [](const TechniqueResult& a, const TechniqueResult& b) {
        return a.equal.best.trial.decibels < b.equal.best.trial.decibels;
    });
}

const TechniqueResult& ViewResult::matched() const {
    const TechniqueResult* found = fastest(techniques, &TechniqueResult::matched);
    return found != nullptr ? *found : *nearest();
}

const BurinTried* ViewResult::burin_at(double decibels) const {
    const BurinTried* found = nullptr;
    for (const BurinTried& one : burin)
        if (one.trial.decibels >= decibels && (found == nullptr || one.trial.milliseconds < found->trial.milliseconds)) found = &one;
    return found;
}

double ViewResult::time_ratio() const {
    const BurinTried& own = is_reached() ? burin[0] : *burin_at(matched_decibels);
    return matched().matched.best.trial.milliseconds / own.trial.milliseconds;
}

Report::Report(const std::string& lines) {
    if (lines.empty()) return;
    lines_ = std::fopen(lines.c_str(), "w");
    if (lines_ == nullptr) std::fprintf(stderr, "%s cannot be written\n", lines.c_str());
}

Report::~Report() {
    if (lines_ != nullptr) std::fclose(lines_);
}

void Report::begin() const {
    std::printf("### At burin's own error\n\n"
                "burin: its default setting. Rival: the fastest that reaches that PSNR. Where none does, in brackets the best that any does, and\n"
                "the fastest of them a decibel below, against burin's fastest setting that is as good. Setting: texels per side, steps, samples per\n"
                "pixel (h: Hammersley). Ratios, rival's over burin's: time; bytes of the map over those of burin's two textures, plain and in blocks.\n\n"
                "| scene | view | burin dB | ms | kB | with prefilter | unreached: best dB | rival | setting | dB | ms | burin ms | time | bytes "
                "| blocks |\n"
                "|---|---|--:|--:|--:|--:|--:|---|---|--:|--:|--:|--:|--:|--:|\n");
}

void Report::add(const ViewResult& result, const Stage& stage) {
    const TechniqueResult& rival = result.matched();
    const Trial& own = result.burin[0].trial;
    const Trial& other = rival.matched.best.trial;
    std::printf("| %s | %s | %.1f | %.1f | %.1f | %.1f | ", result.scene.c_str(), result.view.c_str(), own.decibels, own.milliseconds,
                result.bytes.stored / 1000.0, result.bytes.drawn / 1000.0);
    if (!result.is_reached()) std::printf("(%.1f)", result.nearest()->equal.best.trial.decibels);
    std::printf(" | %s | %s | %.1f | %.1f | %.1f | ", name_of(rival.technique), text_of(rival.matched.best.settings).c_str(), other.decibels,
                other.milliseconds, other.milliseconds / result.time_ratio());
    std::printf(result.is_reached() ? "%.2f | " : "(%.2f) | ", result.time_ratio());
    std::printf("%.0f | %.0f |\n", rival.bytes.plain / result.bytes.stored, rival.bytes.blocks / result.bytes.stored);
    std::fflush(stdout);
    if (lines_ != nullptr) write_lines(result, stage);
    results_.push_back(result);
}

void Report::write_lines(const ViewResult& result, const Stage& stage) const {
    for (const BurinTried& one : result.burin)
        print_json(lines_, result, "burin", one.name, nullptr, one.trial, result.bytes.stored, result.bytes.stored);
    for (const TechniqueResult& technique : result.techniques)
        for (const Tried& one : technique.tried) {
            const MapBytes bytes = stage.bytes_of(one.settings);
            print_json(lines_, result, name_of(technique.technique), text_of(one.settings), &one.settings, one.trial, bytes.plain, bytes.blocks);
        }
    std::fflush(lines_);
}

void Report::print_techniques() const {
    std::printf("\n### Every technique at burin's own error\n\n"
                "Milliseconds of the fastest setting that reaches it; else the best dB, in brackets; slower: already its least setting is.\n\n"
                "| scene | view | burin dB |");
    for (const Technique technique : kTechniques) std::printf(" %s |", name_of(technique));
    std::printf("\n|---|---|--:|--:|--:|--:|--:|--:|\n");
    for (const ViewResult& result : results_) {
        std::printf("| %s | %s | %.1f |", result.scene.c_str(), result.view.c_str(), result.burin[0].trial.decibels);
        for (const TechniqueResult& one : result.techniques) {
            const std::string setting = text_of(one.equal.best.settings);
            if (one.equal.reached) std::printf(" %.1f (%s) |", one.equal.best.trial.milliseconds, setting.c_str());
            else if (one.equal.pruned) std::printf(" slower |");
            else std::printf(" (%.1f dB) |", one.equal.best.trial.decibels);
        }
        std::printf("\n");
    }
}

void Report::print_fixed() const {
    std::printf("\n### At %.0f dB\n\nMilliseconds of the fastest setting of each, burin's chosen as freely.\n\n| scene | view | burin |",
                kFixedDecibels);
    for (const Technique technique : kTechniques) std::printf(" %s |", name_of(technique));
    std::printf(" best rival over burin |\n|---|---|---|--:|--:|--:|--:|--:|--:|\n");
    for (const ViewResult& result : results_) {
        const BurinTried* own = result.burin_at(kFixedDecibels);
        std::printf("| %s | %s |", result.scene.c_str(), result.view.c_str());
        if (own != nullptr) std::printf(" %.1f (%s) |", own->trial.milliseconds, own->name.c_str());
        else std::printf(" unreached |");
        double least = 1e300;
        for (const TechniqueResult& one : result.techniques) {
            if (one.fixed.reached) {
                least = std::min(least, one.fixed.best.trial.milliseconds);
                std::printf(" %.1f |", one.fixed.best.trial.milliseconds);
            } else if (one.fixed.pruned) {
                std::printf(" slower |");
            } else {
                std::printf(" (%.1f dB) |", one.fixed.best.trial.decibels);
            }
        }
        if (own != nullptr && least < 1e300) std::printf(" %.2f |\n", least / own->trial.milliseconds);
        else std::printf(" |\n");
    }
}

void Report::print_summary() const {
    std::printf("\n### Summary\n\n"
                "Views in which burin has %.0f dB or more. Time of the rival over burin's: the median with unreached views counted as slower than any\n"
                "other; the least of the views in which a rival reaches burin's error; and, in the unreached ones, at a decibel below the rivals'\n"
                "best, median and least.\n\n"
                "| scenes | views | unreached | median | least | unreached: median, least | bytes plain: median, least | blocks: median, least |\n"
                "|---|--:|--:|--:|--:|--:|--:|--:|\n",
                kLeastDecibels);
    for (const bool grooves : {true, false}) {
        std::vector<double> ratios, reached, matched, plain, blocks;
        for (const ViewResult& result : results_) {
            if (result.grooves != grooves || result.burin[0].trial.decibels < kLeastDecibels) continue;
            ratios.push_back(result.is_reached() ? result.time_ratio() : 1e300);
            (result.is_reached() ? reached : matched).push_back(result.time_ratio());
            plain.push_back(result.matched().bytes.plain / result.bytes.stored);
            blocks.push_back(result.matched().bytes.blocks / result.bytes.stored);
        }
        if (ratios.empty()) continue;
        std::printf("| %s | %zu | %zu | %s | %s | %s, %s | %s, %s | %s, %s |\n", kind_of(grooves), ratios.size(),
                    matched.size(), median_of(ratios).c_str(), least_of(reached).c_str(), median_of(matched).c_str(), least_of(matched).c_str(),
                    median_of(plain).c_str(), least_of(plain).c_str(), median_of(blocks).c_str(), least_of(blocks).c_str());
    }
}

void Report::end() const {
    print_techniques();
    print_fixed();
    print_summary();
}

}  // namespace burin::rivals
