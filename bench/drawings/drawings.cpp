// Question: how long does a drawing of many path commands take to become an asset?
//
//     bench_drawings [COMMANDS]      10^5 unless given
//
// Three drawings, made at random from a fixed seed: winding strokes of cubics that cross one another, strokes of straight lines, and
// filled blobs of cubics that lie on one another. Time is that of the wall, with all cores; one Markdown table.
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <random>
#include <string>

#include <burin/author.hpp>
#include <burin/svg.hpp>

namespace {

using namespace burin;

class Artist {
  public:
    // Numbers of millimetres with three digits, as drawing programs write them.
    std::string number(double value) {
        char text[32];
        std::snprintf(text, sizeof text, " %.3f", value);
        return text;
    }
    double between(double low, double high) { return low + (high - low) * double(engine_() >> 8) * 0x1p-24; }

    std::string winding(bool cubic) {
        double x = between(20, 980), y = between(20, 980), angle = between(0, 6.283);
        const double step = between(1, 6);
        std::string data = "M" + number(x) + number(y);
        for (int k = 0; k < kCommands; ++k) {
            data += cubic ? "C" : "L";
            for (int j = 0; j < (cubic ? 3 : 1); ++j) {
                angle += between(-0.5, 0.5);
                x += step * std::cos(angle), y += step * std::sin(angle);
                data += number(x) + number(y);
            }
        }
        return "<path fill='none' stroke='#000' stroke-width='0.3' d='" + data + "'/>\n";
    }

    std::string blob() {
        const double x = between(20, 980), y = between(20, 980), size = between(1, 6);
        std::string data;
        const auto at = [&](double radius, double turn) {
            const double angle = 6.283185307 * turn / kCommands;
            return number(x + size * radius * std::cos(angle)) + number(y + size * radius * std::sin(angle));
        };
        for (int k = 0; k < kCommands; ++k) {
            if (k == 0) data += "M" + at(1.0, 0.0);
            data += "C" + at(1.4, k + 0.25) + at(1.4, k + 0.75) + at(1.0, k + 1.0);
        }
        return "<path d='" + data + "Z'/>\n";
    }

    static constexpr int kCommands = 8;  // of a path, beside M

  private:
    std::mt19937 engine_{5};
};

void measure(const char* name, const std::string& text, int commands) {
    const auto begun = std::chrono::steady_clock::now();
    const auto since = [&] { return std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count(); };
    const auto drawing = read_svg(text);
    if (!drawing) return void(std::printf("| %s | %s |\n", name, drawing.error().message.c_str()));
    const double read = since();
    const auto authored = author_asset(drawing->pattern, make_plane(drawing->pattern.size));
    const double whole = since();
    if (!authored) return void(std::printf("| %s | %s |\n", name, authored.error().message.c_str()));
    std::printf("| %s | %d | %d | %.2f ", name, commands, authored->stats.lines + authored->stats.quadratics, read);
    for (const auto& [stage, seconds] : authored->stats.seconds) std::printf("| %.2f ", seconds);
    std::printf("| %.2f | %.1f |\n", whole, double(authored->stats.grid_bytes + authored->stats.data_bytes) / double(1 << 20));
    std::fflush(stdout);
}

}  // namespace

int main(int argc, char** argv) {
    const int commands = argc > 1 ? std::atoi(argv[1]) : 100000;
    std::printf("| drawing | commands | elements | read | resolve | grid | pack | bake | write | whole, s | MiB |\n|---|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|\n");
    for (const char* name : {"strokes of cubics", "strokes of lines", "fills of cubics"}) {
        Artist artist;
        std::string text = "<svg xmlns='http://www.w3.org/2000/svg' width='1000mm' height='1000mm' viewBox='0 0 1000 1000'>\n";
        int made = 0;
        for (; made < commands; made += Artist::kCommands + 1)
            text += name[0] == 'f' ? artist.blob() : artist.winding(name[11] == 'c');
        measure(name, text + "</svg>\n", made);
    }
    return 0;
}
