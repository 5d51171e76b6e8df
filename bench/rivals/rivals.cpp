// burin beside the raster rivals: which is the faster at equal error, and for how many bytes.
//
//     bench_rivals [--scene NAME ...] [--view NAME] [--technique NAME] [--quick] [--finest SIZE] [--pictures FOLDER] [--cache FOLDER] [--lines FILE]
//
// Tables in Markdown go to standard output; --lines gets one JSON object for everything that was drawn.
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <thread>

#include <burin/image_io.hpp>

#include "report.hpp"
#include "search.hpp"

namespace burin::rivals {
namespace {

struct Settings {
    bool quick = false;     // smaller pictures, fewer runs
    std::vector<std::string> scenes;  // only these; none: all flat ones
    std::string view, technique;      // only this one; "": all
    std::string pictures, cache, lines;
    int finest = 8192;
};

int usage(const std::string& word) {
    std::fprintf(stderr,
                 "bench_rivals: error: '%s' is no option or technique, or not followed by what it needs; options: --scene NAME (more than once if wanted) "
                 "--view NAME --technique NAME --quick --finest SIZE (a power of two from 512 to 8192) --pictures FOLDER --cache FOLDER "
                 "--lines FILE\n",
                 word.c_str());
    return 2;
}

// Medians of runs that take turns, of the settings that the first table compares.
void time_in_turns(Stage& stage, ViewResult& result, int runs) {
    BurinTried* own = &result.burin[std::size_t(result.burin_at(result.matched_decibels) - result.burin.data())];
    std::vector<Draw> draws = {*stage.burin([](RenderOptions&) {}), *stage.burin(burin_setting(own->name))};
    std::vector<Trial*> trials = {&result.burin[0].trial, &own->trial};
    for (TechniqueResult& one : result.techniques)
        if (one.matched.reached) {
            draws.push_back(*stage.rival(one.matched.best.settings));
            trials.push_back(&one.matched.best.trial);
        }
    std::vector<std::vector<double>> times(draws.size());
    for (int k = 0; k < runs; ++k)
        for (std::size_t i = 0; i < draws.size(); ++i) times[i].push_back(time_once(draws[i]));
    for (std::size_t i = 0; i < draws.size(); ++i) {
        std::sort(times[i].begin(), times[i].end());
        trials[i]->milliseconds = times[i][times[i].size() / 2];
    }
}

void save_pictures(const Settings& settings, Stage& stage, const ViewResult& result) {
    if (settings.pictures.empty()) return;
    const auto save = [&](const std::string& name, const Draw& draw) {
        std::string path = result.scene + " " + result.view + " " + name;
        std::replace_if(path.begin(), path.end(), [](char letter) { return letter == ' ' || letter == ':' || letter == '/'; }, '_');
        path = settings.pictures + "/" + path + ".png";
        if (Status written = write_png(path, bench::show_difference(draw().image(), stage.truth())); !written)
            std::fprintf(stderr, "%s\n", written.error().message.c_str());
    };
    save("burin", *stage.burin([](RenderOptions&) {}));
    for (const TechniqueResult& one : result.techniques) save(name_of(one.technique), *stage.rival(one.matched.best.settings));
}

// What every technique comes to at burin's error and at the fixed one. Where none reaches burin's, also a decibel below the best of them
// all, since the last decibel may cost a technique most of its time.
void search_techniques(const Settings& settings, Stage& stage, ViewResult& result) {
    SearchLimits limits;
    limits.finest = settings.finest;
    limits.coarsest = std::min(limits.coarsest, limits.finest);
    std::vector<Searcher> searchers;
    for (const Technique technique : kTechniques) {
        if (!settings.technique.empty() && settings.technique != name_of(technique)) continue;
        Searcher searcher(stage, technique, limits);
        TechniqueResult one;
        one.technique = technique;
        one.equal = searcher.find(result.burin[0].trial.decibels);
        one.fixed = searcher.find(kFixedDecibels);
        if (one.equal.reached) limits.slowest = std::min(limits.slowest, one.equal.best.trial.milliseconds);
        result.techniques.push_back(std::move(one));
        searchers.push_back(std::move(searcher));
    }
    result.matched_decibels = result.best() != nullptr ? result.burin[0].trial.decibels : result.nearest()->equal.best.trial.decibels - 1.0;
    for (std::size_t i = 0; i < searchers.size(); ++i) {
        TechniqueResult& one = result.techniques[i];
        one.matched = result.best() != nullptr ? one.equal : searchers[i].find(result.matched_decibels);
        one.bytes = stage.bytes_of(one.matched.best.settings);
        one.tried = searchers[i].tried();
    }
}

Result<ViewResult> measure_view(const Settings& settings, Stage& stage, const bench::Subject& subject) {
    ViewResult result;
    result.scene = subject.name;
    result.view = stage.view().name;
    result.grooves = holds_grooves_only(subject.prepared.resolved);
    result.bytes = burin_bytes(subject.prepared);
    auto burin = try_burin(stage);
    if (!burin) return burin.error();
    result.burin = std::move(*burin);
    search_techniques(settings, stage, result);
    time_in_turns(stage, result, settings.quick ? 5 : 9);
    save_pictures(settings, stage, result);
    return result;
}

void measure_subject(const Settings& settings, const gl::Context& context, const bench::Subject& subject, Report& report) {
    SceneMaps maps(context, subject, settings.finest, settings.cache);
    for (const bench::PlaneView& view : bench::standard_views(subject, settings.quick ? 96 : 160, settings.quick ? 72 : 120)) {
        if (!settings.view.empty() && settings.view != view.name) continue;
        Stage stage(context, subject, maps, view, settings.cache);
        if (!stage.shows_features()) continue;
        const auto result = measure_view(settings, stage, subject);
        if (result) report.add(*result, stage);
        else std::fprintf(stderr, "%s, %s: %s\n", subject.name.c_str(), view.name.c_str(), result.error().message.c_str());
    }
}

int run(const Settings& settings) {
    auto context = gl::open_context(Backend::osmesa);
    if (!context) return std::fprintf(stderr, "bench_rivals: error: %s\n", context.error().message.c_str()), 1;
    std::printf("Renderer: %s. Threads: %u.%s\n\n", (*context)->describe().c_str(), std::thread::hardware_concurrency(),
                settings.quick ? " Quick." : "");
    Report report(settings.lines);
    report.begin();
    for (const scenes::SceneEntry& entry : scenes::scene_table()) {
        const auto& wanted = settings.scenes;
        if (!wanted.empty() && std::find(wanted.begin(), wanted.end(), entry.name) == wanted.end()) continue;
        const scenes::Scene scene = entry.make();
        if (!scene.flat && wanted.empty()) continue;
        for (std::size_t part = 0; part < scene.parts.size(); ++part)
            if (const auto subject = bench::prepare_subject(entry, part)) measure_subject(settings, **context, *subject, report);
            else std::fprintf(stderr, "%s is refused: %s\n", entry.name, subject.error().message.c_str());
    }
    report.end();
    return 0;
}

}  // namespace
}  // namespace burin::rivals

int main(int argc, char** argv) {
    using namespace burin::rivals;
    Settings settings;
    for (int i = 1; i < argc; ++i) {
        const std::string word = argv[i];
        const bool more = i + 1 < argc;
        if (word == "--quick") settings.quick = true;
        else if (word == "--scene" && more) settings.scenes.push_back(argv[++i]);
        else if (word == "--view" && more) settings.view = argv[++i];
        else if (word == "--technique" && more) settings.technique = argv[++i];
        else if (word == "--pictures" && more) settings.pictures = argv[++i];
        else if (word == "--cache" && more) settings.cache = argv[++i];
        else if (word == "--lines" && more) settings.lines = argv[++i];
        else if (word == "--finest" && more) settings.finest = std::atoi(argv[++i]);
        else return usage(word);
    }
    if (settings.finest < 512 || settings.finest > 8192 || (settings.finest & (settings.finest - 1)) != 0) return usage("--finest");
    const auto named = [&](Technique technique) { return settings.technique == name_of(technique); };
    if (!settings.technique.empty() && std::none_of(std::begin(kTechniques), std::end(kTechniques), named)) return usage(settings.technique);
    return run(settings);
}
