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
 * version 4 declare them. The library is {@link LoadedLibrary}'s and stays loaded until the process ends.
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
      function(
          "mjb_rollout",
          JAVA_INT,
          ADDRESS,
          ADDRESS,
          JAVA_INT,
          JAVA_INT,
          ADDRESS,
          JAVA_INT,
          ADDRESS,
          JAVA_INT);
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

  private static RuntimeException failed(Throwable error) {
    return error instanceof RuntimeException known ? known : new IllegalStateException(error);
  }

  static int version() {
    try {
      return (int) VERSION.invokeExact();
    } catch (Throwable error) {
      throw failed(error);
    }
  }

  static MemorySegment load(MemorySegment file, MemorySegment error, int errorSize) {
    try {
      return (MemorySegment) LOAD.invokeExact(file, MemorySegment.NULL, error, errorSize);
    } catch (Throwable thrown) {
      throw failed(thrown);
    }
  }

  static void deleteModel(MemorySegment model) {
    try {
      DELETE_MODEL.invokeExact(model);
    } catch (Throwable error) {
      throw failed(error);
    }
  }

  static MemorySegment makeBatch(
      MemorySegment model, int count, MemorySegment config, MemorySegment error, int errorSize) {
    try {
      return (MemorySegment) MAKE.invokeExact(model, count, config, error, errorSize);
    } catch (Throwable thrown) {
      throw failed(thrown);
    }
  }

  static void deleteBatch(MemorySegment batch) {
    try {
      DELETE.invokeExact(batch);
    } catch (Throwable error) {
      throw failed(error);
    }
  }

  static int rowSize(MemorySegment batch) {
    try {
      return (int) ROW.invokeExact(batch);
    } catch (Throwable error) {
      throw failed(error);
    }
  }

  static MemorySegment state(MemorySegment batch) {
    try {
      return (MemorySegment) STATE.invokeExact(batch);
    } catch (Throwable error) {
      throw failed(error);
    }
  }

  static MemorySegment component(MemorySegment batch, int component, MemorySegment size) {
    try {
      return (MemorySegment) COMPONENT.invokeExact(batch, component, size);
    } catch (Throwable error) {
      throw failed(error);
    }
  }

  static MemorySegment expand(
      MemorySegment batch, MemorySegment name, MemorySegment size, MemorySegment elementSize) {
    try {
      return (MemorySegment) EXPAND.invokeExact(batch, name, size, elementSize);
    } catch (Throwable error) {
      throw failed(error);
    }
  }

  /** Steps the first {@code count} simulations, or those of {@code ids}; returns how many failed. */
  static int step(MemorySegment batch, MemorySegment ids, int count, int steps) {
    try {
      return (int) STEP.invokeExact(batch, ids, count, steps, 0);
    } catch (Throwable error) {
      throw failed(error);
    }
  }

  /** Steps all simulations with controls for every step (n × steps × size); returns how many failed. */
  static int rollout(MemorySegment batch, int steps, MemorySegment controls, int controlSpec) {
    try {
      return (int)
          ROLLOUT.invokeExact(
              batch,
              MemorySegment.NULL,
              0,
              steps,
              controls,
              controlSpec,
              MemorySegment.NULL,
              0);
    } catch (Throwable error) {
      throw failed(error);
    }
  }

  static int reset(MemorySegment batch) {
    try {
      return (int) RESET.invokeExact(batch, MemorySegment.NULL, 0, MemorySegment.NULL, 0);
    } catch (Throwable error) {
      throw failed(error);
    }
  }

  static MemorySegment error(MemorySegment batch, int place) {
    try {
      return (MemorySegment) ERROR.invokeExact(batch, place);
    } catch (Throwable thrown) {
      throw failed(thrown);
    }
  }
}
