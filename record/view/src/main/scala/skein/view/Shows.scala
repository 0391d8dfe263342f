package skein.view

import java.util.concurrent.atomic.AtomicReference

/** The shown flights, in the order in which they were added. */
final class Shows:
  private val shown = AtomicReference(Vector.empty[Show])

  /** Adds a flight; replaces an earlier one of this name. */
  def add(show: Show): Unit =
    val _ = shown.updateAndGet(before => before.filterNot(_.id == show.id) :+ show)

  def all: Vector[Show] = shown.get
