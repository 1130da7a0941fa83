#include "scenes/gltf/accessors.h"

#include <algorithm>
#include <cstring>
#include <limits>
#include <type_traits>

#include <fmt/format.h>

#include "scenes/gltf/failure.h"

namespace cairn::scenes::gltf {
namespace {

/// Calls `each` with a value of the C++ type of a component.
template <typename Each>
void with_type(int component, Each each) {
    switch (component) {
        case TINYGLTF_COMPONENT_TYPE_BYTE:
            each(std::int8_t{});
            break;
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
            each(std::uint8_t{});
            break;
        case TINYGLTF_COMPONENT_TYPE_SHORT:
            each(std::int16_t{});
            break;
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
            each(std::uint16_t{});
            break;
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
            each(std::uint32_t{});
            break;
        default:
            each(float{});
            break;
    }
}

template <typename Number>
float as_float(Number number, bool normalized) {
    if constexpr (std::is_floating_point_v<Number>) {
        return number;
    } else {
        if (!normalized) return static_cast<float>(number);
        constexpr double most = std::numeric_limits<Number>::max();
        return static_cast<float>(std::max(static_cast<double>(number) / most, -1.0));
    }
}

/// Reads `width` components of each selected element and hands them on, converted by `convert`.
template <typename Number, typename Out, typename Convert>
void read_as(const Elements& elements, Selection selection, int width, Out filler, Out* out,
             Convert convert) {
    const int present = std::min(width, elements.width);
    const std::size_t count = selection.empty() ? elements.count : selection.size();
    for (std::size_t i = 0; i < count; ++i) {
        const std::size_t index = selection.empty() ? i : selection[i];
        const std::uint8_t* element = elements.data + index * elements.stride;
        for (int c = 0; c < present; ++c) {
            Number number;
            std::memcpy(&number, element + static_cast<std::size_t>(c) * sizeof(Number), sizeof(Number));
            *out++ = convert(number);
        }
        for (int c = present; c < width; ++c)
            *out++ = filler;
    }
}

template <typename Out>
void fill_zeros(const Elements& elements, Selection selection, int width, Out filler, Out* out) {
    const std::size_t count = selection.empty() ? elements.count : selection.size();
    for (std::size_t i = 0; i < count; ++i)
        for (int c = 0; c < width; ++c)
            *out++ = c < elements.width ? Out{} : filler;
}

/// The end of an array of elements in its view. Safe against overflow. @throws Error  if the view is shorter.
void check_range(const std::string& where, std::uint64_t offset, std::uint64_t stride, std::uint64_t count,
                 std::uint64_t element_bytes, std::uint64_t view_bytes) {
    if (count == 0) return;
    const bool first_fits = element_bytes <= view_bytes && offset <= view_bytes - element_bytes;
    if (first_fits && count - 1 <= (view_bytes - element_bytes - offset) / stride) return;
    if (count > (1ULL << 40U) || offset > (1ULL << 50U))
        fail(where, fmt::format("it has {} elements from byte {}, its buffer view holds {} bytes", count,
                                offset, view_bytes));
    fail(where, fmt::format("it ends at byte {}, its buffer view holds {}",
                            offset + (count - 1) * stride + element_bytes, view_bytes));
}

bool is_component(int type) {
    return (type >= TINYGLTF_COMPONENT_TYPE_BYTE && type <= TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT) ||
           type == TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT || type == TINYGLTF_COMPONENT_TYPE_FLOAT;
}

}  // namespace

std::size_t component_bytes(int component) {
    std::size_t bytes = 0;
    with_type(component, [&](auto number) { bytes = sizeof(number); });
    return bytes;
}

Elements Accessors::shape(const std::string& user, int index) const {
    const tinygltf::Accessor& accessor = source_.model.accessors[static_cast<std::size_t>(index)];
    Elements result;
    result.where = user + ": " + element("accessor", static_cast<std::size_t>(index), accessor.name);
    result.component = accessor.componentType;
    if (!is_component(accessor.componentType))
        fail(result.where, fmt::format("component type {} is none of glTF's", accessor.componentType));
    result.width = tinygltf::GetNumComponentsInType(static_cast<std::uint32_t>(accessor.type));
    // The columns of small matrices are padded; nothing that is read here uses them.
    if (accessor.type == TINYGLTF_TYPE_MAT2 || accessor.type == TINYGLTF_TYPE_MAT3)
        fail(result.where, "a MAT2 or MAT3 where none is expected");
    result.normalized = accessor.normalized;
    result.stride = static_cast<std::size_t>(result.width) * component_bytes(result.component);
    result.count = accessor.count;
    return result;
}

Elements Accessors::elements(const std::string& user, int index) {
    const tinygltf::Accessor& accessor = source_.model.accessors[static_cast<std::size_t>(index)];
    Elements result = shape(user, index);
    if (accessor.bufferView == source_.no_view) {
        budget_.charge(result.where, result.count, result.stride);
    } else {
        const auto bytes = buffers_.view(accessor.bufferView);
        const std::size_t element_bytes = result.stride;
        const std::size_t given =
            source_.model.bufferViews[static_cast<std::size_t>(accessor.bufferView)].byteStride;
        if (given != 0) result.stride = given;
        if (result.stride < element_bytes)
            fail(result.where, fmt::format("its elements take {} bytes, the stride of its buffer view is {}",
                                           element_bytes, result.stride));
        check_range(result.where, accessor.byteOffset, result.stride, result.count, element_bytes,
                    bytes.size());
        if (result.count != 0) result.data = bytes.data() + accessor.byteOffset;
    }
    return accessor.sparse.isSparse ? with_sparse(result, accessor) : result;
}

Elements Accessors::with_sparse(const Elements& dense, const tinygltf::Accessor& accessor) {
    const auto& sparse = accessor.sparse;
    const auto count = static_cast<std::size_t>(sparse.count);
    const std::size_t element_bytes =
        static_cast<std::size_t>(dense.width) * component_bytes(dense.component);
    const std::string where = dense.where + ", sparse";
    const int type = sparse.indices.componentType;
    if (type != TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE && type != TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT &&
        type != TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT)
        fail(where, fmt::format("component type {} cannot be an index", type));

    Elements indices;
    indices.where = where + " indices";
    const auto index_bytes = buffers_.view(sparse.indices.bufferView);
    const auto value_bytes = buffers_.view(sparse.values.bufferView);
    const auto index_offset = static_cast<std::uint64_t>(sparse.indices.byteOffset);
    const auto value_offset = static_cast<std::uint64_t>(sparse.values.byteOffset);
    indices.stride = component_bytes(type);
    check_range(indices.where, index_offset, indices.stride, count, indices.stride, index_bytes.size());
    check_range(where + " values", value_offset, element_bytes, count, element_bytes, value_bytes.size());
    if (count == 0) return dense;
    indices.data = index_bytes.data() + index_offset;
    indices.count = count;
    indices.width = 1;
    indices.component = type;
    std::vector<std::uint32_t> places(count);
    read_integers(indices, {}, 1, places.data());

    budget_.charge(where, dense.count, element_bytes);
    auto storage = std::make_shared<std::vector<std::uint8_t>>(dense.count * element_bytes);
    if (dense.data != nullptr)
        for (std::size_t i = 0; i < dense.count; ++i)
            std::memcpy(storage->data() + i * element_bytes, dense.data + i * dense.stride, element_bytes);
    for (std::size_t i = 0; i < count; ++i) {
        if (places[i] >= dense.count)
            fail(where,
                 fmt::format("index {} is {}, the accessor has {} elements", i, places[i], dense.count));
        std::memcpy(storage->data() + places[i] * element_bytes,
                    value_bytes.data() + value_offset + i * element_bytes, element_bytes);
    }
    Elements result = dense;
    result.data = storage->data();
    result.stride = element_bytes;
    result.storage = std::move(storage);
    return result;
}

void read_floats(const Elements& elements, Selection selection, int width, float filler, float* out) {
    if (elements.data == nullptr) return fill_zeros(elements, selection, width, filler, out);
    with_type(elements.component, [&](auto number) {
        using Number = decltype(number);
        read_as<Number>(elements, selection, width, filler, out,
                        [&](Number value) { return as_float(value, elements.normalized); });
    });
}

void read_integers(const Elements& elements, Selection selection, int width, std::uint32_t* out) {
    const int type = elements.component;
    if (type == TINYGLTF_COMPONENT_TYPE_FLOAT || type == TINYGLTF_COMPONENT_TYPE_BYTE ||
        type == TINYGLTF_COMPONENT_TYPE_SHORT)
        fail(elements.where, fmt::format("component type {} cannot be an index", type));
    if (elements.data == nullptr) return fill_zeros(elements, selection, width, 0U, out);
    with_type(type, [&](auto number) {
        using Number = decltype(number);
        read_as<Number>(elements, selection, width, 0U, out,
                        [](Number value) { return static_cast<std::uint32_t>(value); });
    });
}

}  // namespace cairn::scenes::gltf
