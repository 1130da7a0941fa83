#include "scenes/gltf/schema.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>
#include <span>
#include <string_view>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "scenes/gltf/failure.h"
#include "scenes/gltf/limits.h"
#include "scenes/gltf/schema_tables.h"

namespace cairn::scenes::gltf {
namespace {

using nlohmann::json;

/// The place in the document that is checked. It is turned into text only for an error.
struct Frame {
    const Frame* parent = nullptr;
    std::string_view label;
    const std::size_t* index = nullptr;  ///< null: a single object, not an element of an array
    const json* object = nullptr;
};

std::string name_of(const json* object) {
    if (object == nullptr || !object->is_object()) return {};
    const auto found = object->find("name");
    return found != object->end() && found->is_string() ? found->get<std::string>() : std::string();
}

std::string described(const Frame* frame) {
    if (frame == nullptr || frame->label.empty()) return {};
    const std::string outside = described(frame->parent);
    const std::string here = frame->index == nullptr
                                 ? std::string(frame->label)
                                 : element(frame->label, *frame->index, name_of(frame->object));
    return outside.empty() ? here : outside + ", " + here;
}

std::string shown(const json& value) {
    if (value.is_object()) return "an object";
    if (value.is_array()) return "an array";
    return value.is_string() ? in_quotes(value.get_ref<const std::string&>()) : value.dump();
}

class Checker {
public:
    Checker(const std::string& name, json& document, const Limits& limits)
        : name_(name), document_(document), limits_(limits) {}

    void object(json& value, const Shape& shape, const Frame& frame) {
        if (!value.is_object()) refuse(frame, fmt::format("should be an object, is {}", shown(value)));
        prune(value, shape);
        for (const Property& property : shape.properties) {
            const auto found = value.find(property.name);
            if (found != value.end())
                this->property(*found, property, frame);
            else if (property.required)
                refuse(frame, fmt::format("\"{}\" is missing", property.name));
        }
    }

private:
    /// Removes properties that the tables do not name, so that tinygltf sees only checked ones.
    static void prune(json& value, const Shape& shape) {
        for (auto entry = value.begin(); entry != value.end();) {
            const auto is_entry = [&](const Property& property) { return entry.key() == property.name; };
            entry = std::ranges::any_of(shape.properties, is_entry) ? std::next(entry) : value.erase(entry);
        }
    }

    [[nodiscard]] std::string place_of(const Frame& frame) const {
        const std::string where = described(&frame);
        return where.empty() ? name_ : name_ + ": " + where;
    }

    [[noreturn]] void refuse(const Frame& frame, const std::string& what) const {
        fail(place_of(frame), what);
    }

    [[noreturn]] void wrong_type(const Frame& frame, const Property& property, const char* expected,
                                 const json& value) const {
        refuse(frame, fmt::format("\"{}\" should be {}, is {}", property.name, expected, shown(value)));
    }

    void whole_number(json& value, const Property& property, const Frame& frame, std::uint64_t most) const {
        if (value.is_number_float()) {
            const double number = value.get<double>();
            if (number >= 0.0 && number < 0x1p53 && number == std::floor(number))
                value = static_cast<std::uint64_t>(number);
        }
        if (!value.is_number_unsigned()) wrong_type(frame, property, "a whole number", value);
        if (value.get<std::uint64_t>() > most)
            refuse(frame, fmt::format("\"{}\" is {}, the limit is {}", property.name, shown(value), most));
    }

    [[nodiscard]] std::size_t count_of(const char* target) const {
        const json::json_pointer pointer{std::string(target)};
        if (!document_.contains(pointer)) return 0;
        const json& found = document_.at(pointer);
        return found.is_array() ? found.size() : 0;
    }

    void index(json& value, const Property& property, const Frame& frame) const {
        whole_number(value, property, frame, std::numeric_limits<std::uint64_t>::max());
        const std::size_t count = count_of(property.target);
        if (value.get<std::uint64_t>() >= count) {
            const std::string_view target =
                std::string_view(property.target).substr(std::string_view(property.target).rfind('/') + 1);
            refuse(frame, fmt::format("\"{}\" is {}, the file has {} {}", property.name, shown(value), count,
                                      target));
        }
    }

    void numbers(json& value, const Property& property, const Frame& frame) const {
        if (!value.is_array()) wrong_type(frame, property, "an array of numbers", value);
        if (property.length != 0 && value.size() != property.length)
            refuse(frame, fmt::format("\"{}\" holds {} numbers, not {}", property.name, value.size(),
                                      property.length));
        for (const json& number : value)
            if (!number.is_number()) wrong_type(frame, property, "an array of numbers", number);
    }

    void index_map(json& value, const Property& property, const Frame& frame) const {
        if (!value.is_object()) wrong_type(frame, property, "an object", value);
        for (auto& [key, entry] : value.items()) {
            Property attribute = property;
            attribute.name = key.c_str();
            index(entry, attribute, frame);
        }
    }

    template <typename Each>
    void each_of(json& value, const Property& property, const Frame& frame, Each each) const {
        if (!value.is_array()) wrong_type(frame, property, "an array", value);
        if (value.size() > limits_.*property.most)
            fail_limit(place_of(frame), fmt::format("\"{}\" holds {} elements", property.name, value.size()),
                       property.most, value.size());
        std::size_t i = 0;
        for (json& entry : value) {
            const Frame inner{&frame, property.label, &i, &entry};
            each(entry, inner);
            ++i;
        }
    }

    void property(json& value, const Property& property, const Frame& frame) {
        constexpr std::uint64_t most_whole = 1ULL << 53U;
        constexpr std::uint64_t most_int = std::numeric_limits<std::int32_t>::max();
        switch (property.kind) {
            case Kind::boolean:
                if (!value.is_boolean()) wrong_type(frame, property, "true or false", value);
                break;
            case Kind::string:
                if (!value.is_string()) wrong_type(frame, property, "a string", value);
                break;
            case Kind::number:
                if (!value.is_number()) wrong_type(frame, property, "a number", value);
                break;
            case Kind::numbers:
                numbers(value, property, frame);
                break;
            case Kind::whole:
                whole_number(value, property, frame, most_whole);
                break;
            case Kind::whole_int:
                whole_number(value, property, frame, most_int);
                break;
            case Kind::index:
                index(value, property, frame);
                break;
            case Kind::index_map:
                index_map(value, property, frame);
                break;
            case Kind::indices:
                each_of(value, property, frame,
                        [&](json& entry, const Frame&) { index(entry, property, frame); });
                break;
            case Kind::index_maps:
                each_of(value, property, frame,
                        [&](json& entry, const Frame&) { index_map(entry, property, frame); });
                break;
            case Kind::strings:
                each_of(value, property, frame, [&](json& entry, const Frame&) {
                    if (!entry.is_string()) wrong_type(frame, property, "an array of strings", entry);
                });
                break;
            case Kind::any_object:
                if (!value.is_object()) wrong_type(frame, property, "an object", value);
                break;
            case Kind::object:
                object(value, *property.inside, {&frame, property.name, nullptr, nullptr});
                break;
            case Kind::objects:
                each_of(value, property, frame,
                        [&](json& entry, const Frame& inner) { object(entry, *property.inside, inner); });
                break;
        }
    }

    const std::string& name_;
    json& document_;
    const Limits& limits_;
};

}  // namespace

void check_schema(const std::string& name, json& document, const Limits& limits) {
    Checker(name, document, limits).object(document, schema_of_document(), Frame{});
}

}  // namespace cairn::scenes::gltf
