//! The C that a translating runtime makes of the block, and a program around it.

use crate::st::{Block, Section};
use controller_capi::plc::Vars;

/// Types and macros as such a runtime has them: a value and its flags; a forced variable keeps its value.
const RUNTIME: &str = r"#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef uint8_t IEC_BOOL;
typedef uint8_t IEC_BYTE;
typedef int32_t IEC_DINT;
typedef uint32_t IEC_DWORD;
typedef uint64_t IEC_LWORD;
typedef float IEC_REAL;
typedef double IEC_LREAL;
#define TRUE 1
#define FALSE 0
#define FORCED 0x02
typedef struct { IEC_BOOL value; IEC_BYTE flags; } IEC_BOOL_t;
typedef struct { IEC_DINT value; IEC_BYTE flags; } IEC_DINT_t;
typedef struct { IEC_DWORD value; IEC_BYTE flags; } IEC_DWORD_t;
typedef struct { IEC_REAL value; IEC_BYTE flags; } IEC_REAL_t;
typedef struct { IEC_LREAL value; IEC_BYTE flags; } IEC_LREAL_t;
";

/// Around the pragma.
const MACROS: &str = r"#define GetFbVar(var, ...) data__->var.value __VA_ARGS__
#define SetFbVar(var, val, ...) if (!(data__->var.flags & FORCED)) data__->var.value __VA_ARGS__ = val
";

/// Reads `S instance variable bits` and `C instance`; prints the outputs of each call. Before each call the instance goes to
/// another address, and its old memory is poisoned.
const MAIN: &str = r#"static FB *at[2];

static void move(int i)
{
    FB *there = (FB *)malloc(sizeof(FB));
    if (there == NULL) {
        exit(2);
    }
    memcpy(there, at[i], sizeof(FB));
    memset(at[i], 0xA5, sizeof(FB));
    free(at[i]);
    at[i] = there;
}

static void print(int i, int outputs)
{
    const int count = (int)(sizeof fields / sizeof fields[0]);
    printf("%d", i);
    for (int n = 0; n < count; n++) {
        uint64_t bits = 0;
        if (!outputs || fields[n].output) {
            memcpy(&bits, (const char *)at[i] + fields[n].offset, fields[n].size);
            printf(" %llx", (unsigned long long)bits);
        }
    }
    printf("\n");
}

int main(void)
{
    char what;
    int i, n;
    unsigned long long bits;
    for (i = 0; i < 2; i++) {
        at[i] = (FB *)calloc(1, sizeof(FB));
        if (at[i] == NULL) {
            return 2;
        }
        initialise(at[i]);
        print(i, 0);
    }
    while (scanf(" %c %d", &what, &i) == 2) {
        if (what == 'S') {
            if (scanf("%d %llx", &n, &bits) != 2) {
                return 2;
            }
            uint64_t value = bits;
            memcpy((char *)at[i] + fields[n].offset, &value, fields[n].size);
        } else {
            move(i);
            body(at[i]);
            print(i, 1);
        }
    }
    free(at[0]);
    free(at[1]);
    return 0;
}
"#;

/// The program for a block; the variables have the numbers of their places in the C structure.
pub(crate) fn program(block: &Block) -> String {
    let mut out = RUNTIME.to_string();
    let (words, _) = block.room();
    out += &format!("typedef struct {{ IEC_LWORD table[{words}]; }} TABLE;\n");
    out += "typedef struct { TABLE value; IEC_BYTE flags; } TABLE_t;\n\ntypedef struct {\n";
    let mut first = String::new();
    for v in &block.variables {
        let kind = if v.name == "STATE" { "TABLE_t".into() } else { format!("IEC_{}_t", v.kind) };
        out += &format!("    {kind} {};\n", v.name);
        if !v.initial.is_empty() {
            first += &format!("    data__->{}.value = {};\n", v.name, v.initial);
        }
    }
    out += &format!("}} FB;\n\nstatic void initialise(FB *data__)\n{{\n{first}}}\n\n");
    out += &format!("{MACROS}\nstatic void body(FB *data__)\n{{\n{}", block.pragma);
    out += "    SetFbVar(FAULT, GetFbVar(ERROR) != 0);\n}\n\n";
    out += "static const struct { size_t offset, size; int output; } fields[] = {\n";
    for (field, ..) in Vars::<f32>::fields() {
        let name = crate::name_in_st(field);
        let variable = block.variables.iter().find(|v| v.name == name).expect("a variable for the field");
        let output = i32::from(variable.section == Section::Output);
        out += &format!("    {{ offsetof(FB, {name}), sizeof(((FB *)0)->{name}.value), {output} }},\n");
    }
    out + "};\n\n" + MAIN
}

/// A program that prints the layout of the header's structures and compares its macros with the functions.
pub(crate) fn layout() -> String {
    let mut out = String::from(
        "#include <stdio.h>\n#include \"ctl_fb.h\"\n\nint main(void)\n{\n    int failures = 0;\n",
    );
    for variant in ["f32", "f64"] {
        let kind = format!("ctl_{variant}_fb_vars");
        for (field, ..) in Vars::<f32>::fields() {
            out += &format!(
                "    printf(\"{variant} {field} %u %u\\n\", (unsigned)offsetof({kind}, {field}), (unsigned)sizeof((({kind} *)0)->{field}));\n"
            );
        }
        out += &format!("    printf(\"{variant} vars %u\\n\", (unsigned)sizeof({kind}));\n");
        let big = variant.to_uppercase();
        for delay in [0, 1, 2, 3, 20, 1000, 16_777_215] {
            out += &format!(
                "    failures += ctl_{variant}_fb_size({delay}u) != (size_t)CTL_{big}_FB_SIZE({delay});\n"
            );
            out +=
                &format!("    failures += CTL_{big}_FB_WORDS({delay}) * 8 != CTL_{big}_FB_SIZE({delay});\n");
        }
        out += &format!("    failures += ctl_{variant}_fb_size(CTL_MAX_DELAY + 1u) != 0;\n");
        let without = format!("CTL_{big}_FB_SIZE_WITHOUT_COMPENSATOR");
        out +=
            &format!("    failures += ctl_{variant}_fb_size_without_compensator() != (size_t){without};\n");
        out += &format!("    failures += ctl_{variant}_fb_align() != CTL_{big}_FB_ALIGN;\n");
        out += &format!("    {kind} {variant};\n");
        out +=
            &format!("    failures += ctl_{variant}_fb_initial(&{variant}, sizeof {variant}) != CTL_OK;\n");
        out += &format!(
            "    failures += ctl_{variant}_fb_initial(&{variant}, sizeof {variant} - 1) != CTL_ERROR_STRUCT_SIZE;\n"
        );
        out +=
            &format!("    failures += ctl_{variant}_fb_initial(NULL, sizeof {variant}) != CTL_ERROR_NULL;\n");
    }
    out + "    printf(\"%d failures\\n\", failures);\n    return failures != 0;\n}\n"
}
