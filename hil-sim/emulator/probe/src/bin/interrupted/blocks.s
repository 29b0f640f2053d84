@ Code that is interrupted at each of its instructions; the registers are those of forms.s. A branch to the next instruction stands
@ behind each, because the emulated machine takes an interrupt between basic blocks. In IT blocks it does so where a page of
@ 1024 bytes ends.

@ An instruction, and an entry of the table of places.
.macro at text
8: \text
  b.n 7f
7:
  .section .rodata.places, "a", %progbits
  .word 8b
  .section .text.blocks, "ax", %progbits
.endm

@ An IT block of four wide instructions. The last `behind` bytes of it are in the next page, which makes a place.
.macro split behind, it, first, second, third, fourth
  b.w 8f
  .balign 1024
  .space 1024 - 18 + \behind
8: \it
  \first
  \second
  \third
  \fourth
  .section .rodata.places, "a", %progbits
  .word 8b + 18 - \behind
  .section .text.blocks, "ax", %progbits
.endm

@ A block; an entry of the table is its code and its first place.
.macro block name
  .section .rodata.places, "a", %progbits
9:
  .section .text.blocks, "ax", %progbits
  .balign 4
6:
  .section .rodata.blocks, "a", %progbits
  .word 6b + 1, 9b
  .section .text.blocks, "ax", %progbits
.endm

.section .rodata.places, "a", %progbits
.balign 4
.section .rodata.blocks, "a", %progbits
.balign 4
.global BLOCKS
BLOCKS:

block
  at "adds.w r0, r1, r2"
  at "adcs r3, r4, r5"
  at "sbcs.w r0, r3, r12, lsl #3"
  at "rsbs r4, r1, #0x3fc00"
  at "lsrs.w r5, r2, #32"
  at "rrxs r0, r5"
  at "bfi r3, r4, #7, #11"
  at "sbfx r4, r3, #5, #9"
  at "ssat r5, #9, r1"
  at "usat16 r0, #7, r2"
  at "qdadd r3, r1, r2"
  at "uadd8 r4, r1, r2"
  at "sel r5, r4, r3"
  at "ssub16 r0, r5, r1"
  at "mrs r3, apsr"
  at "smlad r4, r1, r2, r3"
  at "umaal r0, r3, r4, r5"
  at "smlsldx r4, r5, r1, r2"
  at "udiv r0, r4, r11"
  at "mls r3, r0, r11, r4"
  at "ldrd r4, r5, [r7, #8]!"
  at "strd r0, r3, [r7], #-8"
  at "ldrsh.w r0, [r10, #-5]"
  at "str r3, [r10, r6]"
  at "ldm.w r7, {r0, r2, r4, r8, r12, lr}"
  at "stmdb r7!, {r1, r3, r9}"
  at "ldm.n r7!, {r0, r1, r5}"
  at "push.w {r0, r8, r12}"
  at "ldr.w r3, [sp], #4"
  at "pop.w {r4, r5}"
  at "clz r0, r4"
  at "rev16 r3, r5"
  at "cmp r0, r3"
  at "uxtab16 r4, r2, r1, ror #8"
  at "pkhtb r5, r4, r3, asr #9"
  at "teq r5, r4, ror #3"
  at "msr apsr_nzcvqg, r3"
  at "usada8 r0, r1, r2, r3"
  at "smmlsr r4, r1, r2, r5"
  at "mvns.w r5, r4, ror #31"
  b.w form_done

block
  at "vadd.f32 s0, s1, s2"
  at "vmul.f32 s3, s0, s4"
  at "vdiv.f32 s5, s3, s1"
  at "vsqrt.f32 s6, s2"
  at "vmla.f32 s7, s5, s6"
  at "vfnma.f32 s8, s7, s1"
  at "vfms.f32 s17, s8, s16"
  at "vcmpe.f32 s0, s17"
  at "vmrs apsr_nzcv, fpscr"
  at "vmrs r0, fpscr"
  at "vmov r1, r2, s8, s9"
  at "vcvt.s32.f32 s10, s2"
  at "vcvtr.u32.f32 s11, s3"
  at "vcvt.f32.s32 s12, s12, #17"
  at "vcvt.f32.u32 s13, s13, #1"
  at "vcvtb.f16.f32 s14, s7"
  at "vcvtt.f32.f16 s15, s14"
  at "vmov s18, r1"
  at "vmov.f32 s19, #-0.125"
  at "eor r3, r0, #0xc00000"
  at "vmsr fpscr, r3"
  at "vdiv.f32 s20, s1, s2"
  at "vadd.f32 s21, s20, s31"
  at "vldmia r7!, {s22-s25}"
  at "vstmdb r7!, {d4-d6}"
  at "vldr s26, [r7, #8]"
  at "vpush {s3-s6}"
  at "vpop {s27-s30}"
  at "vnmls.f32 s1, s2, s3"
  at "vmrs r4, fpscr"
  b.w form_done

block
  split 12, "itete hi", "addhi.w r0, r1, #1", "addls.w r0, r2, #2", "lslhi.w r0, r0, #1", "eorls.w r0, r0, #5"
  split 8, "ittte ge", "cmpge.w r1, r2", "movge.w r3, #1", "adcge.w r4, r3, r1", "movlt.w r3, #2"
  split 4, "itttt cs", "ldrcs.w r0, [r7]", "adcscs.w r1, r0, r2", "strcs.w r1, [r7, #4]", "smladcs r2, r1, r0, r3"
  split 12, "iteee vs", "vaddvs.f32 s0, s1, s2", "vnegvc.f32 s0, s1", "vmovvc.f32 s3, s0", "vcvtvc.f32.s32 s4, s4, #3"
  split 8, "itett le", "mrsle r5, apsr", "mrsgt r4, apsr", "vmsrle fpscr, r5", "vmrsle r3, fpscr"
  split 4, "itete ne", "stmne.w r7!, {r0, r1}", "ldmeq.w r7, {r0, r1}", "vldmiane r7, {s5, s6}", "vdiveq.f32 s5, s6, s7"
  b.w form_done

.section .rodata.places, "a", %progbits
9:
.section .rodata.blocks, "a", %progbits
.word 0, 9b
