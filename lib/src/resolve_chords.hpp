// Chords: arcs flattened to short segments in uniform buckets, which wrap around when the pattern repeats.
// All questions of the resolve stage about neighbourhood are asked here. Private to lib.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include <burin/pattern.hpp>

namespace burin::resolving {

// A segment with what it stands for.
struct Chord {
    Vec2 a, b;
    double s0 = 0.0, s1 = 1.0;  // parameters on the element
    std::uint32_t path = 0, element = 0;
};

// Tile offset of a copy, in tiles.
struct Shift {
    int x = 0, y = 0;
    friend bool operator==(Shift, Shift) = default;
};

inline Vec2 operator*(Shift shift, Vec2 size) { return {shift.x * size.x, shift.y * size.y}; }

// Uniform buckets over chords. Memory about 16 bytes per chord and bucket it passes.
class ChordIndex {
  public:
    // `repeat`: the plane wraps with period `size`; else the buckets cover the chords' box.
    ChordIndex(std::vector<Chord> chords, Vec2 size, bool repeat);

    const std::vector<Chord>& chords() const { return chords_; }
    Vec2 size() const { return size_; }

    // Calls visit(chord, shift) for every copy (moved by shift * size) that passes a bucket of the box; a
    // copy may come more than once.
    void visit_box(Box box, const std::function<void(std::uint32_t, Shift)>& visit) const;

    // Calls visit for every pair of copies that share a bucket, the first unmoved, first <= second. May
    // repeat.
    void visit_pairs(const std::function<void(std::uint32_t, std::uint32_t, Shift)>& visit) const;

    // Copies in order of growing distance from p, ring by ring of buckets, until visit has returned a
    // distance that no later ring can beat. visit returns the best distance so far.
    void visit_rings(Vec2 p, const std::function<double(std::uint32_t, Shift)>& visit) const;

  private:
    struct Entry {
        std::uint32_t chord;
        Shift tile;  // tile of the bucket that the unmoved chord passed
    };
    struct Bucket {
        int x, y;  // unwrapped
    };
    void fill();
    void size_buckets(Box box);
    template <typename Visit>
    void walk(Vec2 a, Vec2 b, Visit visit) const;
    bool place(Bucket bucket, std::size_t& slot, Shift& tile) const;
    Bucket bucket_at(Vec2 p) const;

    std::vector<Chord> chords_;
    Vec2 size_;
    bool repeat_ = false;
    Vec2 origin_;
    Vec2 side_;
    int cols_ = 1, rows_ = 1;
    std::vector<std::uint32_t> first_;
    std::vector<Entry> entries_;
};

// A proper crossing of two chords; the second is moved by shift * size.
struct ChordCrossing {
    std::uint32_t first = 0, second = 0;
    Shift shift;
    Vec2 position;
};

// All crossings of chords for which `wanted(first, second, shift)` holds, sorted. Decided exactly: the second
// path is thought moved by an infinitesimal vector, so that contacts at vertices count as crossing where the
// chains change sides and as an even number of crossings where they touch.
std::vector<ChordCrossing> find_crossings(
    const ChordIndex& index, const std::function<bool(const Chord&, const Chord&, Shift)>& wanted);

// Distance from p to a segment, and the parameter there, [0, 1].
double segment_distance(Vec2 a, Vec2 b, Vec2 p, double& along);

}  // namespace burin::resolving
