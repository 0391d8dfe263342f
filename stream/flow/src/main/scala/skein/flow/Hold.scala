package skein.flow

import java.util.concurrent.ConcurrentHashMap
import java.util.concurrent.atomic.AtomicBoolean

/** Makes vehicles hold their positions, whatever is decided: one switch for all vehicles that share it, which
  * any thread may change. [[Steer]] obeys it.
  */
final class Hold:
  private val holding   = AtomicBoolean()
  private val listeners = ConcurrentHashMap.newKeySet[() => Unit]()

  def isHeld: Boolean = holding.get

  /** @return false if vehicles were already held */
  def hold(): Boolean = turn(to = true)

  /** @return false if vehicles were not held */
  def release(): Boolean = turn(to = false)

  private def turn(to: Boolean): Boolean =
    val isNew = holding.compareAndSet(!to, to)
    if isNew then listeners.forEach(_())
    isNew

  /** Calls `listener` at every change, until the returned function is called. */
  private[flow] def listen(listener: () => Unit): () => Unit =
    listeners.add(listener): Unit
    () => listeners.remove(listener): Unit
