// The runtime measured: decoder and shader against the truth.
//
//     bench_runtime [QUESTION ...] [--scene NAME] [--setting NAME] [--quick] [--pictures FOLDER] [--cache FOLDER] [--backend egl]
//
// Questions: hits holes pictures memory flicker energy work features grid reference atrium tables cost; without any, all of them. Tables in Markdown go to standard output.
#include <algorithm>
#include <cstdio>
#include <string>
#include <thread>
#include <vector>

#include "questions.hpp"

namespace burin::bench {

std::vector<Configuration> configurations(const Settings& settings) {
    std::vector<Configuration> list = {
        {"points 1", [](RenderOptions& o) { o.antialiasing = Antialiasing::points, o.samples = 1; }},
        {"points 4", [](RenderOptions& o) { o.antialiasing = Antialiasing::points, o.samples = 4; }},
        {"points 16", [](RenderOptions& o) { o.antialiasing = Antialiasing::points, o.samples = 16; }},
        {"regions, 4 rays", [](RenderOptions& o) { o.antialiasing = Antialiasing::regions, o.samples = 1, o.rays = 4; }},
        {"default", [](RenderOptions&) {}},
        {"regions, 16 rays", [](RenderOptions& o) { o.antialiasing = Antialiasing::regions, o.samples = 1, o.rays = 16; }},
        {"regions 4", [](RenderOptions& o) { o.antialiasing = Antialiasing::regions, o.samples = 4, o.rays = 16; }},
    };
    if (!settings.setting.empty()) std::erase_if(list, [&](const Configuration& one) { return one.name != settings.setting; });
    return list;
}

void for_each_subject(const Settings& settings, const std::function<void(const Subject&)>& visit, bool flat_only) {
    for (const scenes::SceneEntry& entry : scenes::scene_table()) {
        if (!settings.scene.empty() && settings.scene != entry.name) continue;
        const scenes::Scene scene = entry.make();
        if (flat_only && !scene.flat && settings.scene.empty()) continue;
        for (std::size_t part = 0; part < scene.parts.size(); ++part) {
            const auto subject = prepare_subject(entry, part);
            if (subject)
                visit(*subject);
            else
                std::printf("| %s | refused: %s |\n", entry.name, subject.error().message.c_str());
        }
    }
}

void print_head(const Settings& settings, const std::string& fixed, int texts, int numbers, const std::vector<std::string>& cells) {
    std::printf("| %s |", fixed.c_str());
    for (const Configuration& configuration : configurations(settings))
        for (const std::string& cell : cells) {
            const char* of = &cell == &cells.front() ? configuration.name : "";
            std::printf(" %s%s%s |", of, *of != 0 && !cell.empty() ? ": " : "", cell.c_str());
        }
    std::printf("\n|");
    for (int i = 0; i < texts; ++i) std::printf("---|");
    for (std::size_t i = 0; i < std::size_t(numbers) + cells.size() * configurations(settings).size(); ++i) std::printf("--:|");
    std::printf("\n");
}

RenderOptions render_options(const Settings& settings, const Subject& subject, const PlaneView& view, const Configuration& configuration) {
    RenderOptions options = options_of(view, subject.prepared.resolved.size);
    options.backend = settings.backend;
    configuration.apply(options);
    return options;
}

namespace {

void print_picture_row(const Settings& settings, const Subject& subject, const PlaneView& view, const PrintCells& print_cells) {
    const TruthPicture truth = draw_truth(subject, view, settings.cache);
    // From far away a map that ends is too small to hold a whole pixel.
    if (std::count(truth.feature.begin(), truth.feature.end(), 1) == 0) return;
    const Asset asset = asset_of(subject, extent_of(view, subject.prepared.resolved));
    std::printf("| %s | %s ", subject.name.c_str(), view.name.c_str());
    for (const Configuration& configuration : configurations(settings))
        print_cells({subject, view, truth, asset}, configuration, render_options(settings, subject, view, configuration));
    std::printf("|\n");
    std::fflush(stdout);
}

}  // namespace

void print_picture_rows(const Settings& settings, const PrintCells& print_cells) {
    for_each_subject(settings, [&](const Subject& subject) {
        for (const PlaneView& view : standard_views(subject, settings.quick ? 96 : 160, settings.quick ? 72 : 120))
            print_picture_row(settings, subject, view, print_cells);
    });
}

namespace {

struct Question {
    const char* name;
    void (*ask)(const Settings&);
};
constexpr Question kQuestions[] = {{"hits", ask_hits},     {"holes", ask_holes},   {"pictures", ask_pictures}, {"memory", ask_memory},
                                    {"flicker", ask_flicker}, {"energy", ask_energy}, {"work", ask_work},
                                    {"features", ask_features}, {"grid", ask_grid}, {"reference", ask_reference},
                                    {"atrium", ask_atrium},   {"tables", ask_tables},   {"cost", ask_cost}};

int usage(const std::string& word) {
    std::fprintf(stderr, "bench_runtime: error: '%s' is no question or option; questions:", word.c_str());
    for (const Question& question : kQuestions) std::fprintf(stderr, " %s", question.name);
    std::fprintf(stderr, "; options: --scene NAME --setting NAME --quick --pictures FOLDER --cache FOLDER --backend osmesa|egl\n");
    return 2;
}

void print_machine(const Settings& settings) {
    const auto renderer = describe_backend(settings.backend);
    std::printf("## Runtime\n\nRenderer: %s. Threads: %u.%s\n", renderer ? renderer->c_str() : renderer.error().message.c_str(),
                std::thread::hardware_concurrency(), settings.quick ? " Quick." : "");
}

}  // namespace
}  // namespace burin::bench

int main(int argc, char** argv) {
    using namespace burin::bench;
    Settings settings;
    std::vector<const Question*> asked;
    for (int i = 1; i < argc; ++i) {
        const std::string word = argv[i];
        const bool more = i + 1 < argc;
        bool known = false;
        for (const Question& question : kQuestions)
            if (word == question.name) asked.push_back(&question), known = true;
        if (known) continue;
        if (word == "--quick") settings.quick = true;
        else if (word == "--scene" && more) settings.scene = argv[++i];
        else if (word == "--setting" && more) settings.setting = argv[++i];
        else if (word == "--pictures" && more) settings.pictures = argv[++i];
        else if (word == "--cache" && more) settings.cache = argv[++i];
        else if (word == "--backend" && more) settings.backend = argv[++i] == std::string("egl") ? burin::Backend::egl : burin::Backend::osmesa;
        else return usage(word);
    }
    if (configurations(settings).empty()) return usage(settings.setting);
    if (asked.empty())
        for (const Question& question : kQuestions) asked.push_back(&question);
    print_machine(settings);
    for (const Question* question : asked) question->ask(settings);
    return 0;
}
