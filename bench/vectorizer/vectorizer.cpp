// The vectorizer against authored truth: twenty patterns, walls of 2 and of 0.4 texel, from maps of 16 bit, 8 bit and JPEG
// of quality 85. Prints a Markdown table of contours, heights, sizes and structure, and a summary.
//
//     vectorizer [--trials yes] [--only NAME,NAME] [--walls 2|0.4] [--damage 16|8|jpeg] [--zoom 2048]
//                [--jobs N] [--worst-pictures FOLDER] [--spots N] [--misses yes] [--patterns FOLDER]
//
// --trials yes: instead of the twenty, maps with grain, shading, clouds and what else breaks tracers. --zoom: side of the
// surfaces that level lines are drawn from. --jobs: maps worked on at a time, each on one thread. --worst-pictures: a
// close-up per row of the 16 x 16 texels that add most to the contours' mean square: true lines green, ours red, paths
// blue. --spots: how many such places are listed below each row. --misses yes: what of the structure does not match is
// listed too. --patterns: writes the maps there and does no more.
#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <mutex>
#include <string>
#include <thread>

#include <burin/image_io.hpp>

#include "authored.hpp"
#include "contour.hpp"
#include "found.hpp"
#include "level_lines.hpp"
#include "patterns.hpp"
#include "picture.hpp"
#include "row.hpp"

namespace burin::bench {
namespace {

constexpr int kSurfaceSamples = 4;  // per side of a place of the surfaces that level lines are drawn from

struct Options {
    std::vector<std::string> only;
    std::vector<double> walls{2.0, 0.4};
    std::vector<Damage> damages{Damage::sixteen_bit, Damage::eight_bit, Damage::jpeg};
    bool trials = false;
    int zoom = 2048, jobs = 2;
    Details details;
    std::string pictures, patterns;
};

// A pattern with walls of one width: what all its rows have in common.
struct Truth {
    Pattern pattern;
    std::vector<double> heights;
    Image map, twice;  // at 512 and 1024
    Image surface;
    std::vector<Segment> lines;
};

Truth truth_of(const Subject& subject, double wall, int zoom) {
    Truth truth;
    truth.pattern = subject.draw(wall);
    truth.heights = half_heights(truth.pattern);
    const ResolvedPattern resolved = resolved_or_exit(truth.pattern, false);
    truth.map = sampled(resolved, kPatternTexels, 40, 1);
    truth.twice = sampled(resolved, 2 * kPatternTexels, 20, 1);
    if (subject.spoil) subject.spoil(truth.map), subject.spoil(truth.twice);
    truth.surface = sampled(resolved, zoom, kSurfaceSamples, 1);
    truth.lines = lines_of(truth.surface, truth.heights, kPatternTexels);
    return truth;
}

double rms_between(const Image& a, const Image& b) {
    double squares = 0.0;
    for (std::size_t i = 0; i < a.texels.size(); ++i) {
        const double d = static_cast<double>(a.texels[i]) - static_cast<double>(b.texels[i]);
        squares += d * d;
    }
    return std::sqrt(squares / static_cast<double>(a.texels.size()));
}

void write_worst(const Options& options, const Row& row, const Truth& truth, const HeightMap& map, const Found& found,
                 const std::vector<Segment>& lines) {
    constexpr int kSide = 48;
    const Vec2 corner{std::clamp(row.worst.x - kSide / 2, 0.0, double(kPatternTexels - kSide)),
                      std::clamp(row.worst.y - kSide / 2, 0.0, double(kPatternTexels - kSide))};
    write_close_up(options.pictures + "/" + row.subject + "_" + text_of(row.wall) + "_" + name_of(row.damage) + ".png", map.image,
                   corner, kSide, truth.lines, lines, chords_of(found.pattern, kPatternTexels));
}

Row measure(const Options& options, const std::string& name, double wall, Damage damage, const Truth& truth,
            const std::string& folder) {
    Row row{.subject = name, .wall = wall, .damage = damage};
    const HeightMap map = damaged(truth.map, damage, folder);
    const Found found = found_in(map, truth.pattern);
    const Image surface = sampled(found.stored, options.zoom, kSurfaceSamples, 1);
    const std::vector<Segment> lines = lines_of(surface, truth.heights, kPatternTexels);
    row.contour = distance_between(truth.lines, lines);
    row.worst = row.contour.spots.empty() ? Vec2{} : row.contour.spots.front().corner + Vec2{8.0, 8.0};
    row.height = rms_between(surface, truth.surface);
    row.bilinear = rms_between(zoomed(map.image, options.zoom, truth.pattern.wrap), truth.surface);
    row.bilinear_twice =
        rms_between(zoomed(damaged(truth.twice, damage, folder).image, options.zoom, truth.pattern.wrap), truth.surface);
    row.structure = compare_structure(truth.pattern, found.pattern, kPatternTexels);
    row.explained = found.explained;
    row.texture_bytes = found.texture_bytes;
    row.elements = found.elements;
    row.seconds = found.seconds;
    if (!options.pictures.empty()) write_worst(options, row, truth, map, found, lines);
    return row;
}

std::vector<std::string> words(const char* text) {
    std::vector<std::string> out;
    std::string word;
    for (const char* p = text;; ++p) {
        if (*p && *p != ',') { word += *p; continue; }
        if (!word.empty()) out.push_back(word);
        word.clear();
        if (!*p) return out;
    }
}

[[noreturn]] void refuse(const std::string& message) {
    std::fprintf(stderr, "vectorizer: %s\n", message.c_str());
    std::exit(2);
}

Damage damage_of(const std::string& word) {
    for (const Damage damage : {Damage::sixteen_bit, Damage::eight_bit, Damage::jpeg})
        if (word == name_of(damage)) return damage;
    refuse("--damage " + word + ": 16, 8 or jpeg");
}

const std::vector<Subject>& asked(const Options& options) { return options.trials ? trials() : subjects(); }

Options read_options(int argc, char** argv) {
    Options options;
    for (int i = 1; i < argc; i += 2) {
        const std::string name = argv[i];
        if (i + 1 == argc) refuse(name + " needs a value");
        const char* value = argv[i + 1];
        if (name == "--only") options.only = words(value);
        else if (name == "--trials") options.trials = std::string(value) == "yes";
        else if (name == "--walls") options.walls = {std::atof(value)};
        else if (name == "--damage") options.damages = {damage_of(value)};
        else if (name == "--zoom") options.zoom = std::atoi(value);
        else if (name == "--jobs") options.jobs = std::atoi(value);
        else if (name == "--spots") options.details.spots = std::atoi(value);
        else if (name == "--misses") options.details.misses = std::string(value) == "yes";
        else if (name == "--worst-pictures") options.pictures = value;
        else if (name == "--patterns") options.patterns = value;
        else refuse("unknown option " + name);
    }
    if (options.zoom < 4 * kPatternTexels || options.zoom > 32 * kPatternTexels) refuse("--zoom lies between 2048 and 16384");
    if (options.jobs < 1) refuse("--jobs is 1 or more");
    for (const std::string& name : options.only)
        if (std::none_of(asked(options).begin(), asked(options).end(), [&](const Subject& s) { return s.name == name; }))
            refuse("--only " + name + ": no such pattern");
    return options;
}

bool wanted(const Options& options, const Subject& subject) {
    return options.only.empty() || std::find(options.only.begin(), options.only.end(), subject.name) != options.only.end();
}

struct Task {
    const Subject* subject;
    double wall;
    std::vector<Row> rows;
    bool done = false;
};

// Rows appear in the order of the tasks, as soon as all before them are done.
class Table {
  public:
    Table(std::vector<Task>& tasks, const Details& details) : tasks_(tasks), details_(details) { print_head(); }

    void finish(Task& task, std::vector<Row> rows) {
        const std::lock_guard lock(mutex_);
        task.rows = std::move(rows);
        task.done = true;
        for (; next_ < tasks_.size() && tasks_[next_].done; ++next_)
            for (const Row& row : tasks_[next_].rows) print_row(row, details_);
        std::fflush(stdout);
    }

  private:
    std::vector<Task>& tasks_;
    std::mutex mutex_;
    std::size_t next_ = 0;
    Details details_;
};

std::string temporary_folder() {
    std::string name = (std::filesystem::temp_directory_path() / "burin_vectorizer_XXXXXX").string();
    if (!mkdtemp(name.data())) refuse(name + ": cannot be made");
    return name;
}

void work(const Options& options, std::vector<Task>& tasks, std::atomic<std::size_t>& next, Table& table) {
    const std::string folder = temporary_folder();
    for (std::size_t i = next++; i < tasks.size(); i = next++) {
        Task& task = tasks[i];
        const Truth truth = truth_of(*task.subject, task.wall, options.zoom);
        std::vector<Row> rows;
        for (const Damage damage : options.damages)
            rows.push_back(measure(options, task.subject->name, task.wall, damage, truth, folder));
        table.finish(task, std::move(rows));
    }
    std::filesystem::remove_all(folder);
}

int run(const Options& options) {
    std::vector<Task> tasks;
    for (const double wall : options.walls)
        for (const Subject& subject : asked(options))
            if (wanted(options, subject)) tasks.push_back({&subject, wall, {}, false});
    if (!options.pictures.empty()) std::filesystem::create_directories(options.pictures);
    Table table(tasks, options.details);
    std::atomic<std::size_t> next{0};
    std::vector<std::thread> threads;
    for (int i = 0; i < options.jobs; ++i) threads.emplace_back([&] { work(options, tasks, next, table); });
    for (std::thread& thread : threads) thread.join();
    std::vector<Row> rows;
    for (const Task& task : tasks) rows.insert(rows.end(), task.rows.begin(), task.rows.end());
    print_summary(rows);
    return 0;
}

int write_patterns(const Options& options) {
    std::filesystem::create_directories(options.patterns);
    for (const Subject& subject : asked(options)) {
        if (!wanted(options, subject)) continue;
        const std::string path = options.patterns + "/" + subject.name + ".png";
        const Status written =
            write_height(path, map_of(subject.draw(options.walls.front()), kPatternTexels, 16));
        if (!written) refuse(path + ": " + written.error().message);
    }
    return 0;
}

}  // namespace
}  // namespace burin::bench

int main(int argc, char** argv) {
    const burin::bench::Options options = burin::bench::read_options(argc, argv);
    return options.patterns.empty() ? burin::bench::run(options) : burin::bench::write_patterns(options);
}
