// SPDX-License-Identifier: Apache-2.0
//
// What a plug-in's pass sees while it runs: its ports, and what is around it. Included by
// hone_pass.hpp.
#ifndef HONE_PASS_RUN_HPP
#define HONE_PASS_RUN_HPP

// Not rooted: plug-ins have these headers alone.
#include "hone_pass.h"
#include "hone_plugin.hpp"

#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <vector>

#pragma GCC visibility push(hidden)

namespace hone::plugin {

// ---- Elements of hone's commonest types ----

struct Error {
    float expect; ///< best guess of |raster - traced|: orders pixels
    float bound;  ///< never below it: 0 = surely right
};
struct Rgb { ///< Radiance, Display
    float r, g, b;
};

/// Rec. 709.
[[nodiscard]] inline float luminance(const Rgb& c) {
    return 0.2126f * c.r + 0.7152f * c.g + 0.0722f * c.b;
}

// ---- Ports: members that are filled in before execute() ----

/// What a pass reads over one edge: a plane, a list or a record.
template <class T> class In {
public:
    In() = default;
    explicit In(const hone_input& input) : input_(&input) {}

    /// Whether anything feeds it: ask it of optional inputs.
    explicit operator bool() const { return input_ != nullptr && input_->data != nullptr; }
    [[nodiscard]] std::size_t size() const { return input_->count; }
    [[nodiscard]] const T* begin() const { return static_cast<const T*>(input_->data); }
    [[nodiscard]] const T* end() const { return begin() + size(); }
    [[nodiscard]] const T& operator[](std::size_t i) const { return begin()[i]; }

    // Planes: pixel (0, 0) is the top left.
    [[nodiscard]] int width() const { return static_cast<int>(input_->width); }
    [[nodiscard]] int height() const { return static_cast<int>(input_->height); }
    [[nodiscard]] const T& operator()(int x, int y) const {
        return begin()[static_cast<std::size_t>(y) * input_->width + static_cast<std::size_t>(x)];
    }
    /// The nearest pixel of the frame.
    [[nodiscard]] const T& clamped(int x, int y) const {
        return (*this)(x < 0         ? 0
                       : x < width() ? x
                                     : width() - 1,
                       y < 0          ? 0
                       : y < height() ? y
                                      : height() - 1);
    }

    /// An edge's own parameter, in the order in which inMany() declared them.
    [[nodiscard]] hone_word param(std::size_t i) const { return input_->params[i]; }
    /// Changes whenever the content does.
    [[nodiscard]] std::uint64_t version() const { return input_->version; }

private:
    const hone_input* input_ = nullptr;
};

/// The edges of an input that takes several.
template <class T> using Many = std::vector<In<T>>;

/// What a pass writes: every element of a plane or record, as many of a list as it says.
template <class T> class Out {
public:
    Out() = default;
    explicit Out(hone_output& output) : output_(&output) {}

    [[nodiscard]] std::size_t size() const { return output_->count; }
    [[nodiscard]] T* begin() const { return static_cast<T*>(output_->data); }
    [[nodiscard]] T* end() const { return begin() + size(); }
    [[nodiscard]] T& operator[](std::size_t i) const { return begin()[i]; }

    // Planes: pixel (0, 0) is the top left.
    [[nodiscard]] int width() const { return static_cast<int>(output_->width); }
    [[nodiscard]] int height() const { return static_cast<int>(output_->height); }
    [[nodiscard]] T& operator()(int x, int y) const {
        return begin()[static_cast<std::size_t>(y) * output_->width + static_cast<std::size_t>(x)];
    }

    // Lists.
    [[nodiscard]] std::size_t capacity() const { return output_->capacity; }
    /// Adds an element; throws std::length_error where there is no room.
    void push(const T& element) const {
        if (output_->count == output_->capacity)
            throw std::length_error("its list is full: its size rule asks for too little");
        begin()[output_->count++] = element;
    }

private:
    hone_output* output_ = nullptr;
};

/// Whoever waits wants control back: thrown by Run::pause().
struct GiveUp {};

/// What a pass sees besides its ports.
class Run {
public:
    Run(const hone_run& run, const Host& the_host) : host(the_host), run_(&run) {}

    const Host& host; ///< threads, log, alpha test

    [[nodiscard]] int width() const { return static_cast<int>(run_->width); } ///< of the frame
    [[nodiscard]] int height() const { return static_cast<int>(run_->height); }
    [[nodiscard]] std::uint64_t seed() const { return run_->seed; }
    /// Inside a loop, from 1; outside 0.
    [[nodiscard]] unsigned iteration() const { return run_->iteration; }

    /// Calls body(x, y) once for every pixel of the frame, on hone's threads, in any order.
    template <class Body> void forEachPixel(const Body& body) const {
        constexpr std::size_t kRows = 4;
        host.parallelFor(run_->height, kRows, [&](std::size_t begin, std::size_t end) {
            for (int y = static_cast<int>(begin); y < static_cast<int>(end); ++y)
                for (int x = 0; x < width(); ++x)
                    body(x, y);
        });
    }

    /// Ends execute() if whoever waits wants control back; between steps of some ten milliseconds.
    /// The next execute() starts where goesOn() allows: it must get a little further each time.
    void pause() const {
        if (run_->is_due(run_) != 0)
            throw GiveUp();
    }
    /// execute() ended by pause() last time, and nothing that it sees changed.
    [[nodiscard]] bool goesOn() const { return run_->goes_on != 0; }

    /// Adds to a counter, by the order of Declare::counter().
    void count(std::uint32_t counter, std::uint64_t amount) const {
        run_->count(run_, counter, amount);
    }

private:
    const hone_run* run_;
};

} // namespace hone::plugin

#pragma GCC visibility pop

#endif
