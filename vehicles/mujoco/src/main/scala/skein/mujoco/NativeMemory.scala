package skein.mujoco

import java.lang.foreign.{Arena, MemorySegment}
import java.util.concurrent.atomic.AtomicLong

/** What MuJoCo has allocated for us. */
private[mujoco] object NativeMemory:
  private val count = AtomicLong()

  /** Models and batches that have been freed. */
  def freed: Long = count.get

  /** The same, freed as soon as nobody refers to what is of this arena any more. */
  def owned(allocated: MemorySegment, arena: Arena)(free: MemorySegment => Unit): MemorySegment =
    allocated.reinterpret(
      arena,
      gone =>
        free(gone)
        count.incrementAndGet(): Unit
    )
