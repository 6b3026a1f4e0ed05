// SPDX-License-Identifier: Apache-2.0
#include "hone/core/scene/gltf_accessor.h"

#include "hone/core/error.h"

#include <algorithm>
#include <cstring>
#include <limits>

namespace hone {
namespace {

/// An accessor without a buffer view is all zeros and costs its file nothing: a bound keeps a small
/// file from asking for all memory.
constexpr std::size_t kMaxZeroElements = std::size_t{1} << 24;

std::size_t componentBytes(int component_type) {
    switch (component_type) {
    case TINYGLTF_COMPONENT_TYPE_BYTE:
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
        return 1;
    case TINYGLTF_COMPONENT_TYPE_SHORT:
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
        return 2;
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
    case TINYGLTF_COMPONENT_TYPE_FLOAT:
        return 4;
    default:
        return 0;
    }
}

template <class T> T load(const std::byte* bytes) {
    T value;
    std::memcpy(&value, bytes, sizeof(T));
    return value;
}

/// glTF 2.0 specification, section 3.11, "Animations": how normalised integers become floats.
template <class T> float loadFloat(const std::byte* bytes, bool normalized) {
    const auto value = static_cast<float>(load<T>(bytes));
    if (!normalized)
        return value;
    return std::max(value / static_cast<float>(std::numeric_limits<T>::max()), -1.0f);
}

float loadFloat(const std::byte* bytes, int component_type, bool normalized) {
    switch (component_type) {
    case TINYGLTF_COMPONENT_TYPE_BYTE:
        return loadFloat<std::int8_t>(bytes, normalized);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
        return loadFloat<std::uint8_t>(bytes, normalized);
    case TINYGLTF_COMPONENT_TYPE_SHORT:
        return loadFloat<std::int16_t>(bytes, normalized);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
        return loadFloat<std::uint16_t>(bytes, normalized);
    default:
        return load<float>(bytes);
    }
}

uint loadUnsigned(const std::byte* bytes, int component_type) {
    switch (component_type) {
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
        return load<std::uint8_t>(bytes);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
        return load<std::uint16_t>(bytes);
    default:
        return load<std::uint32_t>(bytes);
    }
}

/// Elements at a fixed distance, all of them inside their buffer view.
struct Elements {
    const std::byte* first = nullptr;
    std::size_t stride = 0;
    [[nodiscard]] const std::byte* operator[](std::size_t i) const { return first + i * stride; }
};

/// One accessor while it is read: knows its pointer for messages.
class Reader {
public:
    Reader(const GltfFile& file, int index, const std::string& user)
        : file_(file), accessor_(find(file, index, user)),
          pointer_("/accessors/" + std::to_string(index)) {
        if (accessor_.count == 0)
            fail("/count", "0; expected at least 1");
    }

    /// To be called before count elements are allocated.
    void checkCount(std::size_t element_bytes) const {
        if (accessor_.bufferView >= 0)
            (void)locateDense(element_bytes);
        else if (accessor_.count > kMaxZeroElements)
            fail("/count", std::to_string(accessor_.count) +
                               " elements without a buffer view; at most " +
                               std::to_string(kMaxZeroElements) + " are allowed");
    }

    /// Calls take(element index, bytes) for each element: the dense ones in order, then the sparse.
    template <class Take> void each(std::size_t element_bytes, Take take) const {
        if (accessor_.bufferView >= 0) {
            const Elements elements = locateDense(element_bytes);
            for (std::size_t i = 0; i < accessor_.count; ++i)
                take(i, elements[i]);
        }
        if (accessor_.sparse.isSparse)
            eachSparse(element_bytes, take);
    }

    [[noreturn]] void fail(const std::string& place, const std::string& what) const {
        file_.fail(pointer_ + place, what);
    }

    [[nodiscard]] const tinygltf::Accessor& accessor() const { return accessor_; }

private:
    static const tinygltf::Accessor& find(const GltfFile& file, int index,
                                          const std::string& user) {
        if (index < 0 || static_cast<std::size_t>(index) >= file.model.accessors.size())
            file.fail(user, "names accessor " + std::to_string(index) + ", but there are " +
                                std::to_string(file.model.accessors.size()));
        return file.model.accessors[static_cast<std::size_t>(index)];
    }

    [[nodiscard]] Elements locateDense(std::size_t element_bytes) const {
        return locate(accessor_.bufferView, accessor_.byteOffset, accessor_.count, element_bytes,
                      "/bufferView");
    }

    [[nodiscard]] Elements locate(int view_index, std::uint64_t offset, std::uint64_t count,
                                  std::size_t element_bytes, const std::string& place) const {
        const auto view = file_.view(view_index, pointer_ + place);
        const std::size_t declared =
            file_.model.bufferViews[static_cast<std::size_t>(view_index)].byteStride;
        const std::size_t stride = declared == 0 ? element_bytes : declared;
        if (stride < element_bytes)
            fail(place, "byteStride " + std::to_string(stride) + " is less than its " +
                            std::to_string(element_bytes) + " bytes an element");
        // By division and difference: nothing here can wrap around.
        const bool fits = element_bytes <= view.size() && offset <= view.size() - element_bytes &&
                          count - 1 <= (view.size() - element_bytes - offset) / stride;
        if (!fits)
            fail(place, std::to_string(count) + " elements of " + std::to_string(element_bytes) +
                            " bytes, " + std::to_string(stride) + " apart, from byte " +
                            std::to_string(offset) + " on reach past the " +
                            std::to_string(view.size()) + " bytes of buffer view " +
                            std::to_string(view_index));
        return {view.data() + offset, stride};
    }

    template <class Take> void eachSparse(std::size_t element_bytes, Take take) const {
        const auto& sparse = accessor_.sparse;
        const int kind = sparse.indices.componentType;
        if (kind != TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE &&
            kind != TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT &&
            kind != TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT)
            fail("/sparse/indices/componentType",
                 std::to_string(kind) + "; expected 5121, 5123 or 5125");
        if (sparse.count < 1 || static_cast<std::size_t>(sparse.count) > accessor_.count)
            fail("/sparse/count", std::to_string(sparse.count) + "; expected 1 to " +
                                      std::to_string(accessor_.count));
        if (sparse.indices.byteOffset < 0 || sparse.values.byteOffset < 0)
            fail("/sparse", "a negative byteOffset");
        const auto count = static_cast<std::size_t>(sparse.count);
        const Elements indices =
            locate(sparse.indices.bufferView, static_cast<std::size_t>(sparse.indices.byteOffset),
                   count, componentBytes(kind), "/sparse/indices");
        const Elements values =
            locate(sparse.values.bufferView, static_cast<std::size_t>(sparse.values.byteOffset),
                   count, element_bytes, "/sparse/values");
        for (std::size_t i = 0; i < count; ++i) {
            const uint index = loadUnsigned(indices[i], kind);
            if (index >= accessor_.count)
                fail("/sparse/indices", "index " + std::to_string(index) + " is not below the " +
                                            std::to_string(accessor_.count) + " elements");
            take(index, values[i]);
        }
    }

    const GltfFile& file_;
    const tinygltf::Accessor& accessor_;
    std::string pointer_;
};

/// "VEC3" for 3.
std::string typeName(uint components) {
    return components == 1 ? "SCALAR" : "VEC" + std::to_string(components);
}

} // namespace

std::vector<float> readFloats(const GltfFile& file, int accessor, uint components,
                              const std::string& user) {
    const Reader reader(file, accessor, user);
    const int kind = reader.accessor().componentType;
    const int type = components == 1 ? TINYGLTF_TYPE_SCALAR : static_cast<int>(components);
    if (reader.accessor().type != type)
        reader.fail("/type", "expected " + typeName(components) + " for " + user);
    const std::size_t bytes = componentBytes(kind);
    if (bytes == 0 || kind == TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT)
        reader.fail("/componentType", std::to_string(kind) +
                                          "; expected 5126 (float) or a normalised 8 or 16-bit "
                                          "integer for " +
                                          user);
    reader.checkCount(bytes * components);

    std::vector<float> floats(reader.accessor().count * components);
    const bool normalized = reader.accessor().normalized;
    reader.each(bytes * components, [&](std::size_t element, const std::byte* first) {
        for (uint c = 0; c < components; ++c)
            floats[element * components + c] = loadFloat(first + c * bytes, kind, normalized);
    });
    return floats;
}

std::vector<uint> readIndices(const GltfFile& file, int accessor, std::size_t limit,
                              const std::string& user) {
    const Reader reader(file, accessor, user);
    const int kind = reader.accessor().componentType;
    if (reader.accessor().type != TINYGLTF_TYPE_SCALAR)
        reader.fail("/type", "expected SCALAR for " + user);
    if (kind != TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE &&
        kind != TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT &&
        kind != TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT)
        reader.fail("/componentType",
                    std::to_string(kind) + "; expected 5121, 5123 or 5125 (unsigned) for " + user);
    reader.checkCount(componentBytes(kind));

    std::vector<uint> indices(reader.accessor().count);
    reader.each(componentBytes(kind), [&](std::size_t element, const std::byte* first) {
        indices[element] = loadUnsigned(first, kind);
    });
    for (std::size_t i = 0; i < indices.size(); ++i)
        if (indices[i] >= limit)
            reader.fail("", "index " + std::to_string(indices[i]) + " at element " +
                                std::to_string(i) + " is not below the " + std::to_string(limit) +
                                " vertices of " + user);
    return indices;
}

} // namespace hone
