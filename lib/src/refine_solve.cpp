#include "refine_solve.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace burin::refinement {
namespace {

constexpr double kFloor = 1e-6;  // squared map scale per squared unit of an unknown
constexpr int kMostSteps = 400;
constexpr double kReduction = 1e-8;  // of the squared preconditioned residual

struct Entry {
    int row = 0, column = 0;
    double value = 0.0;
};

double product(const std::vector<double>& a, const std::vector<double>& b) {
    return std::inner_product(a.begin(), a.end(), b.begin(), 0.0);
}

std::vector<Entry> entries_of(const std::vector<ElementUnknowns>& elements, const Prediction& prediction) {
    std::vector<Entry> entries;
    for (const Equations& part : prediction.parts) {
        for (const Equations::Pair& pair : part.pairs) {
            const std::vector<int>& rows = elements[pair.first].unknowns;
            const std::vector<int>& columns = elements[pair.second].unknowns;
            const double* block = part.values.data() + pair.offset;
            for (const int row : rows) {
                for (const int column : columns) {
                    const double value = *block++;
                    if (value == 0.0) continue;
                    entries.push_back({row, column, value});
                    // A pair stands for both orders.
                    if (pair.first != pair.second || row != column) entries.push_back({column, row, value});
                }
            }
        }
    }
    return entries;
}

// By row and column. Stable: equal places are summed in the order of the parts.
std::vector<Entry> sorted(const std::vector<Entry>& entries, int rows) {
    std::vector<std::size_t> place(static_cast<std::size_t>(rows) + 1, 0);  // of the row's next entry
    for (const Entry& entry : entries) ++place[static_cast<std::size_t>(entry.row) + 1];
    std::partial_sum(place.begin(), place.end(), place.begin());
    std::vector<Entry> out(entries.size());
    for (const Entry& entry : entries) out[place[static_cast<std::size_t>(entry.row)]++] = entry;
    std::size_t begin = 0;
    for (int row = 0; row < rows; ++row) {
        const std::size_t end = place[static_cast<std::size_t>(row)];  // by now
        std::stable_sort(out.begin() + static_cast<std::ptrdiff_t>(begin), out.begin() + static_cast<std::ptrdiff_t>(end),
                         [](const Entry& a, const Entry& b) { return a.column < b.column; });
        begin = end;
    }
    return out;
}

}  // namespace

NormalEquations::NormalEquations(int unknowns, const std::vector<ElementUnknowns>& elements,
                                 const Prediction& prediction)
    : first_(static_cast<std::size_t>(unknowns) + 1, 0),
      diagonal_(static_cast<std::size_t>(unknowns), 0.0),
      springs_(static_cast<std::size_t>(unknowns), 0.0),
      gradient_(static_cast<std::size_t>(unknowns), 0.0) {
    for (const Equations& part : prediction.parts)
        for (std::size_t e = 0; e < part.gradients.size(); ++e)
            for (std::size_t k = 0; k < part.gradients[e].size(); ++k)
                gradient_[elements[e].unknowns[k]] += part.gradients[e][k];
    const std::vector<Entry> entries = sorted(entries_of(elements, prediction), unknowns);
    int last_row = -1, last_column = -1;
    for (const Entry& entry : entries) {
        if (entry.row == last_row && entry.column == last_column) {
            value_.back() += entry.value;
        } else {
            column_.push_back(entry.column);
            value_.push_back(entry.value);
            ++first_[static_cast<std::size_t>(entry.row) + 1];
            last_row = entry.row, last_column = entry.column;
        }
        if (entry.row == entry.column) diagonal_[entry.row] += entry.value;
    }
    std::partial_sum(first_.begin(), first_.end(), first_.begin());
}

void NormalEquations::add_springs(const std::vector<double>& weight, double factor, const std::vector<double>& moved) {
    for (std::size_t i = 0; i < springs_.size(); ++i) {
        springs_[i] += factor * weight[i];
        gradient_[i] += factor * weight[i] * moved[i];
    }
}

void NormalEquations::multiply(const std::vector<double>& x, const std::vector<double>& damped,
                               std::vector<double>& out) const {
    for (std::size_t row = 0; row < x.size(); ++row) {
        double sum = damped[row] * x[row];
        for (std::size_t k = first_[row]; k < first_[row + 1]; ++k) sum += value_[k] * x[column_[k]];
        out[row] = sum;
    }
}

std::vector<double> NormalEquations::step(const std::vector<double>& damping, const std::vector<std::uint8_t>& held) const {
    const std::size_t count = diagonal_.size();
    // A floor keeps what the map hardly shows from being thrown far.
    std::vector<double> damped(count), inverse(count, 0.0);
    for (std::size_t i = 0; i < count; ++i) {
        damped[i] = damping[i] * diagonal_[i] + springs_[i] + kFloor;
        if (diagonal_[i] > 0.0 && !held[i]) inverse[i] = 1.0 / (diagonal_[i] + damped[i]);
    }
    std::vector<double> x(count, 0.0), r(count), z(count), d(count), q(count);
    for (std::size_t i = 0; i < count; ++i) r[i] = -gradient_[i];
    for (std::size_t i = 0; i < count; ++i) z[i] = inverse[i] * r[i];
    d = z;
    double rho = product(r, z);
    const double target = kReduction * rho;
    for (int iteration = 0; iteration < kMostSteps && rho > target && rho > 0.0; ++iteration) {
        multiply(d, damped, q);
        const double curvature = product(d, q);
        if (!(curvature > 0.0)) break;
        const double alpha = rho / curvature;
        for (std::size_t i = 0; i < count; ++i) x[i] += alpha * d[i], r[i] -= alpha * q[i];
        for (std::size_t i = 0; i < count; ++i) z[i] = inverse[i] * r[i];
        const double next = product(r, z);
        for (std::size_t i = 0; i < count; ++i) d[i] = z[i] + (next / rho) * d[i];
        rho = next;
    }
    return x;
}

}  // namespace burin::refinement
