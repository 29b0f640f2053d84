//! Encodings that an independent assembler produced.
use super::*;

fn effect(first: u16, second: u16) -> Effect {
    decode(0x0800_1000, first, second).effect
}

#[test]
fn instructions_have_the_length_of_their_encoding() {
    for (first, length) in [(0x4770, 2), (0xe7fe, 2), (0xe92d, 4), (0xf000, 4), (0xfb00, 4)] {
        assert_eq!(decode(0, first, 0).length, length, "{first:#x}");
    }
}

#[test]
fn jumps_calls_and_returns_are_decoded() {
    let cases = [
        // b . ; beq .+4 ; cbz r0, .+6 ; cbnz r1, .+0x44
        (0xe7fe, 0, Effect::Jump(0x0800_1000)),
        (0xd000, 0, Effect::Branch(0x0800_1004)),
        (0xb108, 0, Effect::Branch(0x0800_1006)),
        (0xbb01, 0, Effect::Branch(0x0800_1044)),
        // bl .+4 ; bl . ; b.w .-4 ; beq.w .
        (0xf000, 0xf800, Effect::Call(0x0800_1004)),
        (0xf7ff, 0xfffe, Effect::Call(0x0800_1000)),
        (0xf7ff, 0xbffc, Effect::Jump(0x0800_0ffc)),
        (0xf43f, 0xaffe, Effect::Branch(0x0800_1000)),
        // bx lr ; bx r3 ; blx r2 ; mov pc, r0 ; ldr.w pc, [r0]
        (0x4770, 0, Effect::Return(0)),
        (0x4718, 0, Effect::JumpRegister),
        (0x4790, 0, Effect::CallRegister),
        (0x4687, 0, Effect::JumpRegister),
        (0xf8d0, 0xf000, Effect::JumpRegister),
        // tbb [pc, r0] ; tbh [pc, r1, lsl #1] ; udf #254 ; udf.w #0
        (0xe8df, 0xf000, Effect::Table { entry: 1 }),
        (0xe8df, 0xf011, Effect::Table { entry: 2 }),
        (0xdefe, 0, Effect::Undefined),
        (0xf7f0, 0xa000, Effect::Undefined),
        // it eq ; ite ne ; itte lo ; dsb sy ; msr basepri, r0 ; nop ; svc 0
        (0xbf08, 0, Effect::IfThen { same: 1, count: 1 }),
        (0xbf14, 0, Effect::IfThen { same: 1, count: 2 }),
        (0xbf3a, 0, Effect::IfThen { same: 0b011, count: 3 }),
        (0xf3bf, 0x8f4f, Effect::Next),
        (0xf380, 0x8811, Effect::Next),
        (0xbf00, 0, Effect::Next),
        (0xdf00, 0, Effect::Next),
    ];
    for (first, second, expected) in cases {
        assert_eq!(effect(first, second), expected, "{first:04x} {second:04x}");
    }
}

#[test]
fn changes_of_the_stack_pointer_are_decoded() {
    let cases = [
        // push {r4-r7, lr} ; pop {r4-r7, pc} ; push.w {r8-r11} ; pop.w {r8-r11} ; pop.w {r4-r11, pc}
        (0xb5f0, 0, Effect::Stack(20)),
        (0xbdf0, 0, Effect::Return(20)),
        (0xe92d, 0x0f00, Effect::Stack(16)),
        (0xe8bd, 0x0f00, Effect::Stack(-16)),
        (0xe8bd, 0x8ff0, Effect::Return(36)),
        // sub sp, #8 ; add sp, #508 ; sub.w sp, sp, #0x400 ; subw sp, sp, #0x404 ; add.w sp, sp, #0x400
        (0xb082, 0, Effect::Stack(8)),
        (0xb07f, 0, Effect::Stack(-508)),
        (0xf5ad, 0x6d80, Effect::Stack(0x400)),
        (0xf2ad, 0x4d04, Effect::Stack(0x404)),
        (0xf50d, 0x6d80, Effect::Stack(-0x400)),
        // str r8, [sp, #-4]! ; ldr r8, [sp], #4 ; ldr pc, [sp], #4 ; strd r0, r1, [sp, #-8]!
        (0xf84d, 0x8d04, Effect::Stack(4)),
        (0xf85d, 0x8b04, Effect::Stack(-4)),
        (0xf85d, 0xfb04, Effect::Return(4)),
        (0xe96d, 0x0102, Effect::Stack(8)),
        // vpush {d8-d9} ; vpop {d8} ; vstr d0, [sp, #8] ; stm.w sp, {r0, r1} ; ldr r0, [sp, #4]
        (0xed2d, 0x8b04, Effect::Stack(16)),
        (0xecbd, 0x8b02, Effect::Stack(-8)),
        (0xed8d, 0x0b02, Effect::Next),
        (0xe88d, 0x0003, Effect::Next),
        (0xf8dd, 0x0004, Effect::Next),
        // sub sp, sp, r0 ; mov sp, r7 ; add sp, r0 ; add r7, sp, #8
        (0xebad, 0x0d00, Effect::StackUnknown),
        (0x46bd, 0, Effect::StackUnknown),
        (0x4485, 0, Effect::StackUnknown),
        (0xaf02, 0, Effect::Next),
    ];
    for (first, second, expected) in cases {
        assert_eq!(effect(first, second), expected, "{first:04x} {second:04x}");
    }
}

#[test]
fn floating_point_arithmetic_is_distinguished_from_moves() {
    let cases = [
        // vadd.f32 s0, s1, s2 ; vmul ; vdiv ; vcvt.f32.s32 s0, s0 ; vsqrt.f32 s0, s1 ; vcmp.f32 s0, s1 ; vabs.f32 s0, s1
        (0xee30, 0x0a81, true),
        (0xee20, 0x0a81, true),
        (0xee80, 0x0a81, true),
        (0xeeb8, 0x0ac0, true),
        (0xeeb1, 0x0ae0, true),
        (0xeeb4, 0x0a60, true),
        (0xeeb0, 0x0ae0, true),
        // vmov.f32 s0, s1 ; vmov.f32 s0, #1.0 ; vmov s0, r0 ; vmov r0, r1, d0 ; vldr s0, [r0] ; vmrs apsr_nzcv, fpscr
        (0xeeb0, 0x0a60, false),
        (0xeeb7, 0x0a00, false),
        (0xee00, 0x0a10, false),
        (0xec51, 0x0b10, false),
        (0xed90, 0x0a00, false),
        (0xeef1, 0xfa10, false),
    ];
    for (first, second, expected) in cases {
        assert_eq!(decode(0, first, second).float, expected, "{first:04x} {second:04x}");
    }
}

#[test]
fn exclusive_stores_are_recognised() {
    // strex r1, r0, [r2] ; strexb r1, r0, [r2] ; strexh r1, r0, [r2] ; ldrex r0, [r2] ; strd r0, r1, [r2]
    for (first, second, expected) in [
        (0xe842, 0x0100, true),
        (0xe8c2, 0x0f41, true),
        (0xe8c2, 0x0f51, true),
        (0xe852, 0x0f00, false),
        (0xe9c2, 0x0100, false),
    ] {
        assert_eq!(decode(0, first, second).exclusive, expected, "{first:04x} {second:04x}");
    }
}
