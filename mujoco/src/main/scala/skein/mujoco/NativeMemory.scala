package skein.mujoco

import java.lang.foreign.{Arena, MemorySegment}
import java.util.concurrent.atomic.AtomicLong

/** What MuJoCo has allocated for us. */
private[mujoco] object NativeMemory:
  private val count = AtomicLong()

  /** Models and batches that are not freed yet. */
  def held: Long = count.get

  /** The same, freed as soon as nobody refers to what is of this arena any more. */
  def owned(allocated: MemorySegment, arena: Arena)(free: MemorySegment => Unit): MemorySegment =
    count.incrementAndGet()
    allocated.reinterpret(
      arena,
      freed =>
        free(freed)
        count.decrementAndGet(): Unit
    )
