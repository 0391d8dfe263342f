package skein.mujoco;

import static java.lang.foreign.ValueLayout.ADDRESS;
import static java.lang.foreign.ValueLayout.JAVA_INT;

import java.lang.foreign.Arena;
import java.lang.foreign.FunctionDescriptor;
import java.lang.foreign.Linker;
import java.lang.foreign.MemoryLayout;
import java.lang.foreign.MemorySegment;
import java.lang.foreign.SymbolLookup;
import java.lang.invoke.MethodHandle;

/**
 * The functions of MuJoCo's C library that bodies need, as {@code mujoco.h} and {@code mjbatch.h} of
 * version 4 declare them. The library is {@link LoadedLibrary}'s and stays loaded until the process ends. They
 * throw nothing themselves: method handles declare {@code Throwable}.
 */
@SuppressWarnings("restricted")
final class MujocoCalls {
  private static final SymbolLookup LOOKUP =
      SymbolLookup.libraryLookup(LoadedLibrary.path, Arena.global());

  private static final MethodHandle VERSION = function("mj_version", JAVA_INT);
  private static final MethodHandle LOAD =
      function("mj_loadXML", ADDRESS, ADDRESS, ADDRESS, ADDRESS, JAVA_INT);
  private static final MethodHandle DELETE_MODEL = procedure("mj_deleteModel", ADDRESS);
  private static final MethodHandle MAKE =
      function("mjb_makeBatch", ADDRESS, ADDRESS, JAVA_INT, ADDRESS, ADDRESS, JAVA_INT);
  private static final MethodHandle DELETE = procedure("mjb_deleteBatch", ADDRESS);
  private static final MethodHandle ROW = function("mjb_nstate", JAVA_INT, ADDRESS);
  private static final MethodHandle STATE = function("mjb_state", ADDRESS, ADDRESS);
  private static final MethodHandle COMPONENT =
      function("mjb_stateComponent", ADDRESS, ADDRESS, JAVA_INT, ADDRESS);
  private static final MethodHandle EXPAND =
      function("mjb_expand", ADDRESS, ADDRESS, ADDRESS, ADDRESS, ADDRESS);
  private static final MethodHandle STEP =
      function("mjb_step", JAVA_INT, ADDRESS, ADDRESS, JAVA_INT, JAVA_INT, JAVA_INT);
  private static final MethodHandle ROLLOUT =
      function("mjb_rollout", JAVA_INT, ADDRESS, ADDRESS, JAVA_INT, JAVA_INT, ADDRESS, JAVA_INT, ADDRESS, JAVA_INT);
  private static final MethodHandle RESET =
      function("mjb_reset", JAVA_INT, ADDRESS, ADDRESS, JAVA_INT, ADDRESS, JAVA_INT);
  private static final MethodHandle ERROR = function("mjb_error", ADDRESS, ADDRESS, JAVA_INT);

  private MujocoCalls() {}

  private static MethodHandle function(String name, MemoryLayout returns, MemoryLayout... takes) {
    return Linker.nativeLinker()
        .downcallHandle(LOOKUP.findOrThrow(name), FunctionDescriptor.of(returns, takes));
  }

  private static MethodHandle procedure(String name, MemoryLayout... takes) {
    return Linker.nativeLinker()
        .downcallHandle(LOOKUP.findOrThrow(name), FunctionDescriptor.ofVoid(takes));
  }

  static int version() throws Throwable {
    return (int) VERSION.invokeExact();
  }

  static MemorySegment load(MemorySegment file, MemorySegment error, int errorSize) throws Throwable {
    return (MemorySegment) LOAD.invokeExact(file, MemorySegment.NULL, error, errorSize);
  }

  static void deleteModel(MemorySegment model) throws Throwable {
    DELETE_MODEL.invokeExact(model);
  }

  static MemorySegment makeBatch(
      MemorySegment model, int count, MemorySegment config, MemorySegment error, int errorSize) throws Throwable {
    return (MemorySegment) MAKE.invokeExact(model, count, config, error, errorSize);
  }

  static void deleteBatch(MemorySegment batch) throws Throwable {
    DELETE.invokeExact(batch);
  }

  static int rowSize(MemorySegment batch) throws Throwable {
    return (int) ROW.invokeExact(batch);
  }

  static MemorySegment state(MemorySegment batch) throws Throwable {
    return (MemorySegment) STATE.invokeExact(batch);
  }

  static MemorySegment component(MemorySegment batch, int component, MemorySegment size) throws Throwable {
    return (MemorySegment) COMPONENT.invokeExact(batch, component, size);
  }

  static MemorySegment expand(
      MemorySegment batch, MemorySegment name, MemorySegment size, MemorySegment elementSize) throws Throwable {
    return (MemorySegment) EXPAND.invokeExact(batch, name, size, elementSize);
  }

  /** Steps the first {@code count} simulations, or those of {@code ids}; returns how many failed. */
  static int step(MemorySegment batch, MemorySegment ids, int count, int steps) throws Throwable {
    return (int) STEP.invokeExact(batch, ids, count, steps, 0);
  }

  /** Steps all simulations with controls for every step (n × steps × size); returns how many failed. */
  static int rollout(MemorySegment batch, int steps, MemorySegment controls, int controlSpec) throws Throwable {
    return (int)
        ROLLOUT.invokeExact(batch, MemorySegment.NULL, 0, steps, controls, controlSpec, MemorySegment.NULL, 0);
  }

  static int reset(MemorySegment batch) throws Throwable {
    return (int) RESET.invokeExact(batch, MemorySegment.NULL, 0, MemorySegment.NULL, 0);
  }

  static MemorySegment error(MemorySegment batch, int place) throws Throwable {
    return (MemorySegment) ERROR.invokeExact(batch, place);
  }
}
