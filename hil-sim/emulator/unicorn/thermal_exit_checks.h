/* Included before every source file of Unicorn 2.1, by CFLAGS in .cargo/config.toml. It leaves out checks that find nothing here
 * and slow an emulated run down; ../README.md says by how much.
 *
 * Unicorn's translator calls check_exit_request() behind every load and store, and saves all guest registers for it, so that
 * uc_emu_stop() in a callback of the access ends the run there. The emulated machine calls uc_emu_stop() in hooks of blocks,
 * instructions and exceptions only, which have checks of their own. An error of a load leaves the block by itself; an error of a
 * store waits for the check, so it is made to leave as a load's does.
 *
 * The macros stand between the calls and the functions, and tell by the first word of the argument whether they stand before a
 * declaration or a call. A call is recognised by local variables of the functions around it, beside which the declarations below
 * are out of sight: memop of those that translate loads and stores, val and retaddr of that which stores. If another version of
 * Unicorn has other names, the checks are back, and runs are slower; or it does not compile.
 */
#ifndef THERMAL_EXIT_CHECKS_H
#define THERMAL_EXIT_CHECKS_H

/* Of other sizes than the local variables. */
extern char memop[3];
extern char val[3];
extern char retaddr[3];

struct CPUState;
void cpu_loop_exit_restore_arm(struct CPUState *cpu, __UINTPTR_TYPE__ pc);

#define THERMAL_IS_LOCAL(name) (sizeof(name) != 3)
#define THERMAL_SECOND(first, second, ...) second
/* The macro for calls if the words of the argument are those of a call, else the function itself. */
#define THERMAL_CHOOSE(...) THERMAL_SECOND(__VA_ARGS__, 0)

/* Declared with `TCGContext *`, called with `tcg_ctx`. */
#define check_exit_request_arm(context) \
    THERMAL_CHOOSE(THERMAL_CHECK_##context, check_exit_request_arm)(context)
#define THERMAL_CHECK_tcg_ctx 0, THERMAL_CHECK
#define THERMAL_CHECK(context) \
    (THERMAL_IS_LOCAL(memop) ? (void)0 : check_exit_request_arm(context))

/* Declared with `CPUState *`, called with `uc->cpu`. */
#define cpu_exit(cpu) THERMAL_CHOOSE(THERMAL_EXIT_##cpu, cpu_exit)(cpu)
#define THERMAL_EXIT_uc 0, THERMAL_EXIT, 0
#define THERMAL_EXIT(cpu) \
    (cpu_exit(cpu), \
     THERMAL_IS_LOCAL(val) && uc->nested_level > 0 && !(cpu)->stopped \
         ? cpu_loop_exit_restore_arm(cpu, (__UINTPTR_TYPE__)retaddr) \
         : (void)0)

#endif
