"""The tuned numbers of the sources, and copies of these sources that read them from the environment.

A tuned number is a constant `k...` of a file of SOURCES, outside of functions. EXAMPLES has the kinds
of declarations that are read. The compiler computes the values: expressions may be of any kind.
"""
import dataclasses
import os
import re
import subprocess
import tempfile

ROOT = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
SOURCES = ("engine/tuning.h", "kernels/reference/bending.h", "kernels/reference/bodies.h",
           "kernels/reference/contacts.h", "kernels/simd/contacts.h")
EXAMPLES = """
struct Patience {
  double fall;
  int most = 4;  // times
};
inline constexpr double kOne = 1. / 60, kOther = 2 * kOne;  // s, and s, too
constexpr std::size_t kMany{std::size_t{1} << 10};
inline constexpr float kFloat = std::numeric_limits<float>::max();
inline constexpr Patience kPatience{0.9, 8}, kNamed{.fall = 0.5, .most = 2 * 3};
inline constexpr double kThree[] = {1, 2 * (3 + 4), /* the last */ 3};
inline constexpr std::array<std::uint32_t, 2> kTwo{{4, 5}};
"""
NAMES_OF_EXAMPLES = ("kOne kOther kMany kFloat kPatience.fall kPatience.most kNamed.fall "
                     "kNamed.most kThree[0] kThree[1] kThree[2] kTwo[0] kTwo[1]").split()

COMMENT = re.compile(r"//[^\n]*|/\*.*?\*/", re.S)
DECLARATION = re.compile(r"^(?:inline +)?constexpr +"
                         r"([\w:]+(?:<[^;={]*>)?) +(?=k[A-Z]\w*\s*[\[={])", re.M)
ITEM = re.compile(r"\s*(k[A-Z]\w*)\s*(\[[^\]]*\])?\s*=?\s*")
STRUCT = re.compile(r"^struct (\w+) \{(.*?)^\};", re.M | re.S)
FIELD = re.compile(r"^ *([\w:]+) (\w+)(?: *=[^;]*)?; *$", re.M)
STD_ARRAY = re.compile(r"std::array<([\w:]+), *[^>]+>")
KIND = re.compile(r"double|float|int|std::size_t|std::u?int\d+_t")

READING = """#pragma once
#include <cstdlib>
namespace weft::ablation {
template <class T>
static T number(const char* name, T value) {
  const char* text = std::getenv(name);
  return text ? static_cast<T>(std::strtod(text, nullptr)) : value;
}
}  // namespace weft::ablation
"""


@dataclasses.dataclass
class Number:
    name: str    # as C++ writes it
    kind: str    # a type of C++
    first: int   # where its value stands in the file
    last: int

    @property
    def whole(self):
        return self.kind not in ("double", "float")

    @property
    def constant(self):
        return re.match(r"\w+", self.name)[0]


def read(path):
    with open(f"{ROOT}/{path}", encoding="utf-8") as file:
        return file.read()


def without_comments(text):
    """Each place keeps its number."""
    return COMMENT.sub(lambda match: re.sub(r"[^\n]", " ", match[0]), text)


def parts_of(text, first, until):
    """[first, last) of what stands between commas from there to `until`, and where that is."""
    depth, parts, begin = 0, [], first
    for at in range(first, len(text)):
        char = text[at]
        if depth == 0 and char == until:
            return parts + [(begin, at)] * bool(text[begin:at].strip()), at
        if depth == 0 and char == ",":
            parts.append((begin, at))
            begin = at + 1
        depth += (char in "([{") - (char in ")]}")
    raise ValueError(f"no {until!r} after {text[first:first + 60]!r}")


def fields_of(text):
    return {match[1]: FIELD.findall(match[2]) for match in STRUCT.finditer(text)}


def values_of(text, first, last):
    """[first, last) of each value of an initializer, which may be in braces, or in two pairs."""
    values = [(first, last)]
    while len(values) == 1 and text[slice(*values[0])].strip().startswith("{"):
        values = parts_of(text, text.index("{", values[0][0]) + 1, "}")[0]
    return values


def numbers_of_item(text, kind, structs, first, last):
    item = ITEM.match(text, first, last)
    array = STD_ARRAY.fullmatch(kind)
    values = values_of(text, item.end(), last) if item else []
    name = item and item[1]
    if kind in structs:
        names = [(f"{name}.{field}", of) for of, field in structs[kind]]
    elif array or item and item[2]:
        names = [(f"{name}[{k}]", array[1] if array else kind) for k in range(len(values))]
    else:
        names = [(name, kind)]
    if not values or len(names) != len(values) or not all(KIND.fullmatch(of) for _, of in names):
        raise ValueError(f"cannot read the number {text[first:last].strip()!r} of {kind}")
    return [Number(name, of, *at) for (name, of), at in zip(names, values)]


def declarations_of(text):
    """[first, last) of each, with its numbers."""
    text = without_comments(text)
    structs = fields_of(text)
    found = []
    for match in DECLARATION.finditer(text):
        items, last = parts_of(text, match.end(), ";")
        numbers = [number for item in items
                   for number in numbers_of_item(text, match[1], structs, *item)]
        found.append((match.start(), last + 1, numbers))
    return found


def numbers_of(path):
    return [number for *_, numbers in declarations_of(read(path)) for number in numbers]


def changed_declaration(text, first, last, numbers):
    """It takes its numbers from the environment."""
    result, at = "", first
    for number in numbers:
        value = re.sub(r"^\.\w+\s*=\s*", "", text[number.first:number.last].strip())  # of a field
        result += text[at:number.first]
        result += f'::weft::ablation::number<{number.kind}>("{number.name}", {value})'
        at = number.last
    return (result + text[at:last]).replace("constexpr", "const", 1)


def changed(path, text):
    """The text of a source file whose numbers come from the environment."""
    if path not in SOURCES:
        return re.sub(r"\bconstexpr (?=.*\btuning::)", "const ", text)
    result, at = "", 0
    for first, last, numbers in declarations_of(text):
        result += text[at:first] + changed_declaration(text, first, last, numbers)
        at = last
    return (result + text[at:]).replace("#pragma once\n",
                                        '#pragma once\n#include "ablation/number"\n', 1)


def probe(texts):
    """A program that prints a line for each number: its name, its value, and that of the copy."""
    parts, prints = [], []
    for k, text in enumerate(texts):
        declarations = declarations_of(text)
        structs = "\n".join(match[0] for match in STRUCT.finditer(text)
                            if any(re.search(rf"\b{match[1]} +k", text[first:last])
                                   for first, last, _ in declarations))
        original = "\n".join(text[first:last] for first, last, _ in declarations)
        copy = "\n".join(changed_declaration(text, *of) for of in declarations)
        parts.append(f"namespace original_{k} {{\n{structs}\n{original}\n}}\n"
                     f"namespace copy_{k} {{\n{structs}\n{copy}\n}}\n")
        prints += [f'print("{number.name}", original_{k}::{number.name}, copy_{k}::{number.name});'
                   for *_, numbers in declarations for number in numbers]
    includes = "".join(f"#include <{name}>\n"
                       for name in ("array", "cmath", "cstddef", "cstdint", "cstdio", "limits"))
    return (READING.replace("#pragma once\n", includes) + "".join(parts) +
            "template <class T>\nvoid print(const char* name, T original, T copy) {\n"
            '  std::printf("%s %.17g %.17g\\n", name, double(original), double(copy));\n}\n'
            "int main() {\n" + "\n".join(prints) + "\n}\n")


class Values:
    """Computed by the compiler: `original` as the sources have them, `copy` with numbers set."""

    def __init__(self, compiler, texts):
        self.folder = tempfile.TemporaryDirectory()
        self.program = f"{self.folder.name}/probe"
        source = f"{self.program}.cpp"
        with open(source, "w", encoding="utf-8") as file:
            file.write(probe(texts))
        subprocess.run([compiler, "-std=c++20", "-o", self.program, source], check=True)
        self.original = {name: value for name, (value, _) in self.read({}).items()}

    def copy(self, setting):
        return {name: value for name, (_, value) in self.read(setting).items()}

    def read(self, setting):
        printed = subprocess.run([self.program], env={**os.environ, **setting}, check=True,
                                 capture_output=True, text=True).stdout
        rows = [line.split() for line in printed.splitlines()]
        return {name: (float(original), float(copy)) for name, original, copy in rows}


def all_numbers():
    """By their names, in the order of the sources."""
    found = {}
    for path in SOURCES:
        for number in numbers_of(path):
            if number.name in found:
                raise ValueError(f"two numbers are called {number.name}")
            found[number.name] = number
    return found


def values(compiler):
    """By the names of all numbers."""
    return Values(compiler, [read(path) for path in SOURCES]).original


def constants_of(path):
    """What looks like a constant: in tuning.h anywhere, elsewhere in lines that are not indented."""
    text = without_comments(read(path))
    if path != "engine/tuning.h":
        text = "\n".join(re.findall(r"^(?:inline |constexpr )[^;(]*;", text, re.M))
    return set(re.findall(r"\b(k[A-Z]\w*)\s*(?:\[[^\]]*\])?\s*[={]", text))


def used_in(*folders):
    """Constants of engine/tuning.h that the sources in these folders use."""
    used = set()
    for folder in folders:
        for at, _, names in os.walk(f"{ROOT}/{folder}"):
            for name in names:
                if not name.endswith((".h", ".cpp")):
                    continue
                text = without_comments(read(f"{os.path.relpath(at, ROOT)}/{name}"))
                used |= set(re.findall(r"\btuning::(k[A-Z]\w*)", text))
    return used


def faults_of_names():
    for path in SOURCES:
        parsed = {number.constant for number in numbers_of(path)}
        for constant in sorted(constants_of(path) - parsed):
            yield f"{path}: {constant} is not read"
    parsed, used = {number.constant for number in numbers_of("engine/tuning.h")}, used_in("engine")
    for constant in sorted(used - parsed):
        yield f"tuning::{constant} is used, and not read"
    for constant in sorted(parsed - used):
        yield f"tuning::{constant} is used nowhere"
    examples = [number.name for *_, numbers in declarations_of(EXAMPLES) for number in numbers]
    if examples != NAMES_OF_EXAMPLES:
        yield f"the examples are read as {' '.join(examples)}"


def faults_of_values(compiler):
    """The copy has the values of the sources, or those that are set."""
    probe_of_all = Values(compiler, [read(path) for path in SOURCES] + [EXAMPLES])
    original, copy = probe_of_all.original, probe_of_all.copy({})
    other = {name: value / 2 if value > 1e30 else 2 * value + 1 for name, value in original.items()}
    set_by_it = probe_of_all.copy({name: repr(value) for name, value in other.items()})
    for name, value in original.items():
        if copy[name] != value:
            yield f"{name} is {value:g}, and {copy[name]:g} in the copy"
        if abs(set_by_it[name] - other[name]) > 1e-6 * abs(other[name]):
            yield f"{name} is set to {other[name]:g}, and the copy has {set_by_it[name]:g}"


def faults(compiler):
    """Lines that tell why these numbers are not those of the sources; none if they are."""
    return [*faults_of_names(), *faults_of_values(compiler)]
