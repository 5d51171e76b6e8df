// Where a line ends on another or in a node, its traced points follow the middle of both: the last of them lead astray, and
// curves fitted to them turn about within less than the line's width. There it goes straight on.
#include "vectorize_fit.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "resolve_curve.hpp"

namespace burin::vectorizing {
namespace {

constexpr double kReaches[] = {2.0, 3.0, 4.0};  // half-widths from the end, the more the more acute the angle it ends at
constexpr double kLeastTurn = 0.2;  // radians
constexpr double kMoreThan = 2.0;   // times the turn of as long a stretch before

// A place on a row of elements.
struct Cut {
    std::size_t element = 0;
    double at = 0.0;  // parameter
};

// The place so far before another; the beginning, where there is less before it.
Cut back_from(const std::vector<Element>& elements, Cut from, double by) {
    for (;; --from.element, from.at = 1.0) {
        const double before = curve::arc_length(curve::part(elements[from.element], 0.0, from.at));
        if (before > by) return {from.element, from.at * (1.0 - by / before)};
        if (from.element == 0) return {0, 0.0};
        by -= before;
    }
}

// All turns from one place to another, added up.
double turns_between(const std::vector<Element>& elements, Cut from, Cut to) {
    double sum = 0.0;
    Vec2 last = curve::tangent(elements[from.element], from.at);
    for (std::size_t i = from.element; i <= to.element; ++i) {
        const double begin = i == from.element ? from.at : 0.0, end = i == to.element ? to.at : 1.0;
        for (const double s : {begin, 0.5 * (begin + end), end}) {
            const Vec2 next = curve::tangent(elements[i], s);
            sum += std::fabs(turn_between(last, next));
            last = next;
        }
    }
    return sum;
}

// Whether the last `reach` texels turn about; if so, they are straight then.
bool straighten_tail(std::vector<Element>& elements, double reach) {
    constexpr double kShortest = 1.0;  // texels
    const Cut end{elements.size() - 1, 1.0}, cut = back_from(elements, end, reach), before = back_from(elements, cut, reach);
    const Element& bearer = elements[cut.element];
    if (cut.at == 0.0 || curve::arc_length(bearer) < kShortest) return false;
    const double turn = turns_between(elements, cut, end);
    if (turn < kLeastTurn || turn < kMoreThan * turns_between(elements, before, cut)) return false;
    const Vec2 tip = elements.back().p2;
    if (std::fabs(turn_between(curve::tangent(bearer, cut.at), tip - curve::point(bearer, cut.at))) > 0.5 * turn) return false;
    elements.resize(cut.element + 1);
    Element& last = elements.back();
    // What runs straight for long goes on as it is.
    if (last.kind == ElementKind::line && length(last.p2 - last.p0) > 2.0 * reach) return last.p2 = tip, true;
    last = curve::part(last, 0.0, cut.at);
    elements.push_back({ElementKind::line, last.p2, {}, tip});
    return true;
}

}  // namespace

void straighten_tails(FittedChain& fitted) {
    const Chain& chain = fitted.chain;
    if (chain.closed || chain.kind == ChainKind::step || chain.spot != Spot::no) return;
    for (int end = 0; end < 2; ++end) {
        const bool is_hidden = chain.end_tie == EndTie::node || chain.end_tie == EndTie::chain;
        for (std::size_t i = 0; is_hidden && i < std::size(kReaches); ++i)
            if (straighten_tail(fitted.elements, kReaches[i] * chain.half_width + 0.5)) break;
        reverse_chain(fitted);
    }
}

}  // namespace burin::vectorizing
