package skein.mujoco

import java.lang.foreign.{Arena, MemorySegment}
import java.util.concurrent.atomic.AtomicLong

/** Memory that MuJoCo has allocated for this process. */
private[mujoco] object NativeMemory:
  private val count = AtomicLong()

  /** Number of models and batches that have been freed. */
  def freed: Long = count.get

  /** Ties memory to an arena and frees it once nothing refers to the arena's segments any more. */
  def owned(allocated: MemorySegment, arena: Arena)(free: MemorySegment => Unit): MemorySegment =
    allocated.reinterpret(
      arena,
      gone =>
        free(gone)
        count.incrementAndGet(): Unit
    )
