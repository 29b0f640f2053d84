@ The instruction forms. Every form may use r0 to r5, lr, the flags and s0 to s31 freely. r7 is an aligned address in
@ the middle of a block of memory and r10 one of any alignment; r6 and r11 are offsets of 0 to 28. The stack pointer must be as
@ before at the end of a form, and no register may hold an address of the code, which another compiler may move.

.fpu fpv4-sp-d16

@ A form: its code, and an entry of the table with the addresses of code and name.
.macro form text
  .section .text.forms, "ax", %progbits
  .balign 4
8: \text
  b.w form_done
  .section .rodata.form_names, "a", %progbits
9: .asciz "\text"
  .section .rodata.form_table, "a", %progbits
  .word 8b + 1, 9b
.endm

.section .rodata.form_table, "a", %progbits
.balign 4
.global FORMS
FORMS:

@ Data processing with three operands.
.irp op, and, orr, eor, bic, orn, add, adc, sub, sbc, rsb
  .irp suffix, .w, s.w
    .irp second, "r2", "r2, lsl #3", "r2, lsr #32", "r2, asr #7", "r2, ror #13", "r2, rrx"
      form "\op\suffix r0, r1, \second"
    .endr
  .endr
  .irp suffix, "", s
    .irp second, 0, 0xab, 0x00ab00ab, 0xab00ab00, 0xabababab, 0x3fc00
      form "\op\suffix r0, r1, #\second"
    .endr
  .endr
.endr
.irp op, mov, mvn
  .irp suffix, .w, s.w
    .irp second, "r2", "#0x3fc00", "#0xff00ff00"
      form "\op\suffix r0, \second"
    .endr
  .endr
.endr
.irp op, lsl, lsr, asr, ror
  .irp suffix, .w, s.w
    form "\op\suffix r0, r1, #1"
    form "\op\suffix r0, r1, #31"
    form "\op\suffix r0, r1, r2"
  .endr
.endr
form "rrx r0, r1"
form "rrxs r0, r1"
form "lsrs.w r0, r1, #32"
form "asrs.w r0, r1, #32"
.irp op, cmp, cmn, tst, teq
  .irp second, "r2", "r2, lsl #5", "r2, asr #31", "r2, rrx", "#0x7f800000", "#1"
    form "\op\().w r1, \second"
  .endr
.endr
form "movw r0, #0xbeef"
form "movt r0, #0xbeef"
form "addw r0, r1, #0xfff"
form "subw r0, r1, #0xfff"
.irp second, "#0x00ff00ff", "#0xff00ff00", "#0xfefefefe", "#0x1fe"
  form "adds r0, r1, \second"
  form "sbcs r0, r1, \second"
.endr
form "adds r0, r1, r2; adcs r3, r4, r5"
form "subs r0, r1, r2; sbcs r3, r4, r5"
form "rsbs r0, r1, r2, lsl #31"
form "subs.w r0, r1, r1"

@ The narrow encodings.
.irp op, and, eor, lsl, lsr, asr, adc, sbc, ror, orr, bic
  form "\op\()s.n r0, r0, r1"
.endr
form "adds.n r0, r1, r2"
form "subs.n r0, r1, r2"
form "adds.n r0, r1, #7"
form "subs.n r0, r1, #7"
form "adds.n r0, #255"
form "subs.n r0, #255"
form "rsbs.n r0, r1, #0"
form "muls r0, r1, r0"
form "mvns.n r0, r1"
form "movs.n r0, #200"
form "movs.n r0, r1"
form "mov.n r0, r12"
form "add.n r0, r12"
form "cmp.n r0, r1"
form "cmp.n r0, r12"
form "cmp.n r0, #99"
form "cmn.n r0, r1"
form "tst.n r0, r1"
form "lsls.n r0, r1, #4"
form "lsrs.n r0, r1, #32"
form "asrs.n r0, r1, #32"
form "add.n r0, sp, #8; sub.n sp, #8; add.n sp, #8; movs r0, #0"
.irp op, sxtb, sxth, uxtb, uxth, rev, rev16, revsh
  form "\op\().n r0, r1"
  form "\op\().w r0, r1"
.endr
form "cbz r0, 7f; adds r1, #1; 7: adds r2, #1"
form "cbnz r0, 7f; adds r1, #1; 7: adds r2, #1"

@ Extension, bit fields, saturation, arithmetic on parts of a word.
.irp op, sxtb, sxth, uxtb, uxth, sxtb16, uxtb16
  form "\op r0, r1, ror #8"
  form "\op r0, r1, ror #24"
.endr
.irp op, sxtab, sxtah, uxtab, uxtah, sxtab16, uxtab16
  form "\op r0, r1, r2"
  form "\op r0, r1, r2, ror #16"
.endr
form "clz r0, r1"
form "rbit r0, r1"
form "bfi r0, r1, #3, #9"
form "bfi r0, r1, #0, #32"
form "bfi r0, r1, #31, #1"
form "bfc r0, #0, #32"
form "sbfx r0, r1, #31, #1"
form "ubfx r0, r1, #0, #32"
form "bfc r0, #5, #20"
form "sbfx r0, r1, #7, #11"
form "sbfx r0, r1, #0, #32"
form "ubfx r0, r1, #7, #11"
form "ubfx r0, r1, #31, #1"
form "ssat r0, #9, r1"
form "ssat r0, #32, r1, lsl #3"
form "ssat r0, #1, r1, asr #5"
form "ssat r0, #32, r1"
form "ssat r0, #17, r1, lsl #31"
form "ssat r0, #17, r1, asr #31"
form "usat r0, #9, r1"
form "usat r0, #31, r1, lsl #3"
form "usat r0, #0, r1, asr #5"
form "usat r0, #31, r1"
form "usat r0, #17, r1, lsl #31"
form "usat r0, #17, r1, asr #31"
form "ssat16 r0, #1, r1"
form "ssat16 r0, #16, r1"
form "usat16 r0, #0, r1"
form "usat16 r0, #15, r1"
form "ssat16 r0, #7, r1"
form "usat16 r0, #7, r1"
form "sel r0, r1, r2"
form "pkhbt r0, r1, r2"
form "pkhbt r0, r1, r2, lsl #9"
form "pkhtb r0, r1, r2, asr #9"
form "pkhbt r0, r1, r2, lsl #31"
form "pkhtb r0, r1, r2, asr #32"
.irp op, qadd, qsub, qdadd, qdsub
  form "\op r0, r1, r2"
.endr
.irp kind, s, q, sh, u, uq, uh
  .irp op, add8, add16, asx, sax, sub8, sub16
    form "\kind\op r0, r1, r2"
  .endr
.endr
form "usad8 r0, r1, r2"
form "usada8 r0, r1, r2, r3"

@ Multiplication and division.
form "mul r0, r1, r2"
.irp op, mla, mls, smlabb, smlabt, smlatb, smlatt, smlawb, smlawt, smlad, smladx, smlsd, smlsdx, smmla, smmlar, smmls, smmlsr
  form "\op r0, r1, r2, r3"
.endr
.irp op, umull, umlal, smull, smlal, umaal, smlalbb, smlalbt, smlaltb, smlaltt, smlald, smlaldx, smlsld, smlsldx
  form "\op r0, r1, r2, r3"
.endr
.irp op, smulbb, smulbt, smultb, smultt, smulwb, smulwt, smuad, smuadx, smusd, smusdx, smmul, smmulr, sdiv, udiv
  form "\op r0, r1, r2"
.endr
form "mul r0, r0, r0"
form "sdiv r0, r1, r1"
form "udiv r0, r0, r1; mls r2, r0, r1, r2"
form "smull r0, r1, r1, r0"
form "umaal r0, r1, r1, r0"

@ Q behind dual multiplications, also where the conditions of an IT block skip what is behind.
.irp op, smlad, smladx
  form "\op r0, r1, r2, r3; mrs r4, apsr"
  form "\op r1, r1, r1, r1"
  form "\op r0, r1, r2, r3; b.n 7f; 7: mrs r4, apsr"
  form "\op r0, r1, r2, r3; smlabb r0, r1, r2, r3"
  form "itt cs; \op\()cs r0, r1, r2, r3; mrscs r4, apsr"
  form "itet cs; \op\()cs r0, r1, r2, r3; movcc r4, #1; mrscs r5, apsr"
  form "iteet cs; \op\()cs r0, r1, r2, r3; movcc r4, #1; movcc r5, #1; mrscs r0, apsr"
  form "iteee cs; \op\()cs r0, r1, r2, r3; movcc r4, #1; movcc.w r5, #1; movcc.w r3, #2"
  form "itete cs; \op\()cs r0, r1, r2, r3; movcc r4, #1; \op\()cs r1, r0, r2, r3; movcc r5, #2"
.endr

@ Loads and stores.
.irp op, ldr, ldrb, ldrh, ldrsb, ldrsh, str, strb, strh
  .irp address, "[r10, r6]", "[r10, #9]", "[r10, #-5]", "[r10, r11, lsl #2]", "[r10, #6]!", "[r10], #-7"
    form "\op r0, \address"
  .endr
.endr
.irp op, ldr, ldrb, ldrh, ldrsb, ldrsh, str, strb, strh
  form "\op\().n r0, [r7, r6]"
.endr
form "ldr.n r0, [r7, #12]"
form "ldrb.n r0, [r7, #13]"
form "ldrh.n r0, [r7, #14]"
form "str.n r0, [r7, #12]"
form "strb.n r0, [r7, #13]"
form "strh.n r0, [r7, #14]"
.irp op, ldrt, ldrbt, ldrht, ldrsbt, ldrsht, strt, strbt, strht
  form "\op r0, [r10, #9]"
.endr
form "ldrb.w r0, [pc, #4]; b.n 6f; nop; .word 0x765432f0; 6:"
form "ldrh.w r0, [pc, #4]; b.n 6f; nop; .word 0x7654f210; 6:"
form "ldrsh.w r0, [pc, #4]; b.n 6f; nop; .word 0x7654f210; 6:"
form "ldrd r0, r1, 7f; b.n 6f; .balign 4; 7: .word 0x89abcdef, 0x1234567; 6:"
form "pld [r10, #4]; nop.w; dmb; dsb; isb; sev"
form "ldr r0, 7f; b.n 6f; .balign 4; 7: .word 0x89abcdef; 6:"
form "ldr.w r0, [pc, #4]; b.n 6f; nop; .word 0x76543210; 6:"
form "ldrsb.w r0, [pc, #4]; b.n 6f; nop; .word 0x765432f0; 6:"
form "adr.w r0, . + 8; mov r1, pc; sub.w r0, r0, r1"
.irp address, "[r7, #8]", "[r7, #-12]", "[r7, #16]!", "[r7], #-8"
  form "ldrd r0, r1, \address"
  form "strd r0, r1, \address"
.endr
form "ldm.n r7!, {r0, r1, r5}"
form "ldm.n r7, {r0, r7}"
form "stm.n r7!, {r0, r1, r5}"
form "ldm.w r7, {r0, r2, r4, r8, r12, lr}"
form "ldmdb r7!, {r0, r2, r4, r8}"
form "ldmdb r7, {r3, r9}"
form "stm.w r7!, {r0, r2, r4, r8, r12, lr}"
form "stmdb r7!, {r1, r3, r9}"
form "stmdb r7, {r1, r3, r9}"
form "push.n {r0, r3, lr}; pop.w {r4, r5, r12}"
form "push.w {r0, r8, r12}; pop.n {r1, r2, r3}"
form "push.n {r2}; ldr.w r3, [sp], #4"
form "ldrex r0, [r7, #4]; strex r1, r2, [r7, #4]"
form "ldrexb r0, [r10]; strexb r1, r2, [r10]"
form "ldrexh r0, [r7]; strexh r1, r2, [r7]"
form "ldrex r0, [r7]; clrex; strex r1, r2, [r7]"
form "clrex; strex r1, r2, [r7]"
form "ldrex r0, [r7]; strex r1, r2, [r7]; strex r3, r4, [r7]"
form "and r5, #3; tbb [pc, r5]; 7: .byte (1f-7b)/2, (2f-7b)/2, (3f-7b)/2, (4f-7b)/2; 1: adds r0, #1; 2: adds r0, #2; 3: adds r0, #4; 4:"
form "and r5, #3; tbh [pc, r5, lsl #1]; 7: .short (1f-7b)/2, (2f-7b)/2, (3f-7b)/2, (4f-7b)/2; 1: adds r0, #1; 2: adds r0, #2; 3: adds r0, #4; 4:"

@ Conditions and branches.
.irp condition, eq, ne, cs, cc, mi, pl, vs, vc, hi, ls, ge, lt, gt, le
  form "it \condition; add\condition r0, r1, r2"
  form "b\condition\().n 7f; adds r1, #1; 7: adds r2, #1"
  form "b\condition\().w 7f; adds r1, #1; 7: adds r2, #1"
.endr
form "itete hi; addhi r0, r1, #1; addls r0, r2, #2; lslhi r0, r0, #1; eorls r0, r0, #5"
form "ittt ge; cmpge r1, r2; movge r3, #1; movge r4, #2"
form "itt cs; ldrcs r0, [r7]; strcs r1, [r7, #4]"
form "ite eq; vmoveq.f32 s0, s1; vnegne.f32 s0, s1"
form "7: bl 6f; adds r1, #1; 6: adds r2, #1; adr.w r0, 7b; sub.w lr, lr, r0; mov.w r0, #0"
form "adr.n r0, 7f; adds r0, #1; bx r0; .balign 4; 7: adds r2, #1; mov.w r0, #0"
form "adr.n r0, 7f; adds r0, #1; blx r0; .balign 4; 7: adds r2, #1; sub.w lr, lr, r0; mov.w r0, #0"
form "adr.n r0, 7f; adds r0, #1; push {r0}; pop {pc}; .balign 4; 7: adds r2, #1; mov.w r0, #0"
form "adr.n r0, 7f; adds r0, #1; mov pc, r0; .balign 4; 7: adds r2, #1; mov.w r0, #0"

@ Special registers.
form "mrs r0, apsr"
form "msr apsr_nzcvq, r0"
form "msr apsr_g, r0"
form "msr apsr_nzcvqg, r0"
form "mrs r0, ipsr"
form "mrs r0, xpsr"
form "mrs r0, control"
form "itet cs; mrscs r0, control; movcc r4, #1; movcs r5, r0"
form "mov r4, #4; msr control, r4; isb; vmrs r0, fpscr"
form "mov r4, #0; msr control, r4; isb; mov r4, #4; msr control, r4; isb; vadd.f32 s0, s1, s2; vmrs r0, fpscr"
form "msr psp, r0; mrs r1, psp; mov r2, #0; msr psp, r2"

@ The stack pointer, which is a multiple of 4, as it is before and behind; no register may hold its value.
.macro stack text
  form "and r0, #3; mov r4, sp; orr r5, r4, r0; \text; mov r3, sp; mov sp, r4; sub r3, r3, r4; movs r4, #0; movs r5, #0"
.endm
stack "mov.n sp, r5"
stack "mov.w sp, r5"
stack "add.n sp, r0"
stack "add.w sp, sp, r0"
stack "sub.w sp, sp, r0"
stack "add.w sp, sp, #3"
stack "sub.w sp, sp, #5"
stack "subw sp, sp, #1027"
stack "str r5, [r7]; ldr.w sp, [r7]; str r0, [r7]"
stack "strb.w r0, [sp, #-1]!"
stack "strh.w r0, [sp, #-6]!"
stack "msr msp, r5"
stack "cmp r1, r2; itet eq; moveq sp, r5; movne r1, #1; moveq r2, r0"
stack "cmp r1, r2; iteet hi; movhi sp, r5; movls r1, #1; movls r2, #1; subhi.w r2, sp, r4"
form "mrs r0, primask; cpsid i; mrs r1, primask; cpsie i"
form "and r0, #0xf0; msr basepri, r0; mrs r1, basepri; msr basepri_max, r2; mrs r3, basepri; and r3, #0xf0; movs r0, #0; msr basepri, r0"

@ Single precision.
.irp op, vadd, vsub, vmul, vdiv, vnmul, vmla, vmls, vnmla, vnmls, vfma, vfms, vfnma, vfnms
  form "\op\().f32 s0, s1, s2"
.endr
form "vadd.f32 s30, s31, s17"
.irp op, vadd, vsub, vmul, vdiv, vmla, vmls, vfma, vfms, vfnma, vfnms
  form "\op\().f32 s3, s3, s3"
.endr
form "vmul.f32 s0, s1, s2; vadd.f32 s0, s0, s3; vmrs r0, fpscr"
.irp op, vabs, vneg, vsqrt
  form "\op\().f32 s0, s1"
.endr
form "vmov.f32 s0, s1"
form "vmov.f32 s0, #1.0"
form "vmov.f32 s0, #-0.125"
form "vmov.f32 s0, #31.0"
form "vcmp.f32 s0, s0; vmrs apsr_nzcv, fpscr"
.irp op, vcmp, vcmpe
  form "\op\().f32 s0, s1; vmrs apsr_nzcv, fpscr"
  form "\op\().f32 s0, #0.0; vmrs apsr_nzcv, fpscr"
.endr
.irp type, s32, u32
  form "vcvt.\type\().f32 s0, s1"
  form "vcvtr.\type\().f32 s0, s1"
  form "vcvt.f32.\type s0, s1"
  form "vcvt.f32.\type s0, s0, #1"
  form "vcvt.f32.\type s0, s0, #17"
  form "vcvt.\type\().f32 s0, s0, #1"
  form "vcvt.\type\().f32 s0, s0, #17"
  form "vcvt.f32.\type s1, s1, #32"
  form "vcvt.\type\().f32 s1, s1, #32"
  form "vcvt.f32.\type s31, s31, #16; vmov.f32 s0, s31"
  form "ite cs; vcvtcs.f32.\type s0, s0, #1; vmovcc.f32 s0, s1"
  form "itet cs; vcvtcs.f32.\type s0, s0, #5; movcc r4, #1; vaddcs.f32 s2, s0, s0"
.endr
.irp type, s16, u16
  form "vcvt.f32.\type s0, s0, #9"
  form "vcvt.\type\().f32 s0, s0, #9"
  form "vcvt.\type\().f32 s0, s0, #16"
  form "vcvt.f32.\type s0, s0, #16"
  form "vcvt.\type\().f32 s0, s0, #1"
.endr
.irp half, b, t
  form "vcvt\half\().f32.f16 s0, s1"
  form "vcvt\half\().f16.f32 s0, s1"
.endr
form "vmov s0, r0"
form "vmov r0, s1"
form "vmov s3, s4, r0, r1"
form "vmov r0, r1, s3, s4"
form "vmov d3, r0, r1"
form "vmov r0, r1, d3"
form "vmov.32 d2[1], r0"
form "vmov.32 r0, d2[1]"
form "vmov.32 d2[0], r0"
form "vmov.32 r0, d2[0]"
form "vmrs r0, fpscr"
form "vmsr fpscr, r0; vmrs r1, fpscr"
form "vldr s0, [r7, #8]"
form "vldr s0, [r7, #-12]"
form "vldr d1, [r7, #8]"
form "vstr s0, [r7, #8]"
form "vstr d1, [r7, #-8]"
form "vldr s0, 7f; b.n 6f; .balign 4; 7: .word 0x40490fdb; 6:"
form "vldmia r7!, {s1-s5}"
form "vldmdb r7!, {s1-s5}"
form "vldmia r7, {d4-d6}"
form "vldmdb r7!, {d4-d6}"
form "vstmia r7!, {d4-d6}"
form "vstmdb r7!, {d4-d6}"
form "vldmia r7!, {s31}"
form "vldr d7, 7f; b.n 6f; .balign 4; 7: .word 0x40490fdb, 0x7f800001; 6:"
form "vstmia r7!, {s1-s5}"
form "vstmdb r7!, {s1-s5}"
form "vpush {s3-s6}; vpop {s10-s13}"
form "vpush {d3-d4}; vpop {d6-d7}"

.section .rodata.form_table, "a", %progbits
  .word 0, 0
