package skein.view

import java.util.concurrent.atomic.AtomicReference

/** The flights that can be looked at: those that came, in their order. */
final class Shows:
  private val shown = AtomicReference(Vector.empty[Show])

  /** A later one with the same name takes the place of the earlier. */
  def add(show: Show): Unit =
    val _ = shown.updateAndGet(before => before.filterNot(_.id == show.id) :+ show)

  def all: Vector[Show] = shown.get
