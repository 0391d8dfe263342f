package skein.mujoco

import java.lang.foreign.ValueLayout.{ADDRESS, JAVA_INT}
import java.lang.foreign.{Arena, FunctionDescriptor, Linker, MemoryLayout, SymbolLookup}
import java.nio.file.Path

/** The functions of MuJoCo's C library that bodies need, as `mujoco.h` and `mjbatch.h` of version 4 declare
  * them; to be called by `invokeExact`. The library stays loaded until the process ends.
  */
private[mujoco] final class MujocoCalls(library: Path):
  private val linker = Linker.nativeLinker()
  private val lookup = SymbolLookup.libraryLookup(library, Arena.global())

  private def function(name: String, returns: MemoryLayout, takes: MemoryLayout*) =
    linker.downcallHandle(lookup.findOrThrow(name), FunctionDescriptor.of(returns, takes*))

  private def procedure(name: String, takes: MemoryLayout*) =
    linker.downcallHandle(lookup.findOrThrow(name), FunctionDescriptor.ofVoid(takes*))

  val version     = function("mj_version", JAVA_INT)
  val load        = function("mj_loadXML", ADDRESS, ADDRESS, ADDRESS, ADDRESS, JAVA_INT)
  val deleteModel = procedure("mj_deleteModel", ADDRESS)
  val makeBatch   = function("mjb_makeBatch", ADDRESS, ADDRESS, JAVA_INT, ADDRESS, ADDRESS, JAVA_INT)
  val deleteBatch = procedure("mjb_deleteBatch", ADDRESS)
  val rowSize     = function("mjb_nstate", JAVA_INT, ADDRESS)
  val state       = function("mjb_state", ADDRESS, ADDRESS)
  val component   = function("mjb_stateComponent", ADDRESS, ADDRESS, JAVA_INT, ADDRESS)
  val expand      = function("mjb_expand", ADDRESS, ADDRESS, ADDRESS, ADDRESS, ADDRESS)

  /** Steps the first simulations of a number, or those of a list; returns how many failed. */
  val step = function("mjb_step", JAVA_INT, ADDRESS, ADDRESS, JAVA_INT, JAVA_INT, JAVA_INT)

  /** Steps all simulations with controls for every step (n × steps × size); returns how many failed. */
  val rollout = function(
    "mjb_rollout",
    JAVA_INT,
    Seq(ADDRESS, ADDRESS, JAVA_INT, JAVA_INT, ADDRESS, JAVA_INT, ADDRESS, JAVA_INT)*
  )

  val reset = function("mjb_reset", JAVA_INT, ADDRESS, ADDRESS, JAVA_INT, ADDRESS, JAVA_INT)
  val error = function("mjb_error", ADDRESS, ADDRESS, JAVA_INT)
