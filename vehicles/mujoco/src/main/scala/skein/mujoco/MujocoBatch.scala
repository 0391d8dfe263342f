package skein.mujoco

import java.lang.foreign.ValueLayout.{JAVA_BYTE, JAVA_DOUBLE, JAVA_INT}
import java.lang.foreign.{Arena, MemorySegment}
import skein.mujoco.MujocoLibrary.calls

/** A batch of simulations of one model: MuJoCo's `mjBatch`, stepped by the calling thread. The state of one
  * simulation is a row of values. Its memory is freed once it is unreachable. Not thread-safe.
  */
private[mujoco] final class MujocoBatch private (batch: MemorySegment, count: Int, arena: Arena):
  import MujocoBatch.*

  val row: Int = calls.rowSize.invokeExact(batch)

  private val rows =
    val state = calls.state.invokeExact(batch): MemorySegment
    state.reinterpret(count.toLong * row * 8, arena, null)
  private val ids = arena.allocate(JAVA_INT, count)
  private var due = 0

  def apply(place: Int, index: Int): Double = rows.getAtIndex(JAVA_DOUBLE, place.toLong * row + index)

  def update(place: Int, index: Int, value: Double): Unit =
    rows.setAtIndex(JAVA_DOUBLE, place.toLong * row + index, value)

  def rowOf(place: Int): Array[Double] = Array.tabulate(row)(apply(place, _))

  def setRow(place: Int, values: Array[Double]): Unit =
    MemorySegment.copy(values, 0, rows, JAVA_DOUBLE, place.toLong * row * 8, row)

  /** The offset and length of a part of the state in a row. */
  def part(component: Int): Part =
    val size  = arena.allocate(JAVA_INT)
    val start = calls.component.invokeExact(batch, component, size): MemorySegment
    Part(((start.address - rows.address) / 8).toInt, size.get(JAVA_INT, 0))

  def doubles(field: String): Array[Double] =
    fieldOf(field, 8)((at, index) => at.getAtIndex(JAVA_DOUBLE, index))

  def ints(field: String): Array[Int] = fieldOf(field, 4)((at, index) => at.getAtIndex(JAVA_INT, index))

  def flags(field: String): Array[Boolean] =
    fieldOf(field, 1)((at, index) => at.get(JAVA_BYTE, index) != 0)

  private def fieldOf[A: scala.reflect.ClassTag](name: String, bytes: Int)(read: (MemorySegment, Long) => A) =
    val size    = arena.allocate(JAVA_INT)
    val element = arena.allocate(JAVA_INT)
    val text    = arena.allocateFrom(name)
    val at      = calls.expand.invokeExact(batch, text, size, element): MemorySegment
    require(at.address != 0, s"MuJoCo has no field $name")
    require(element.get(JAVA_INT, 0) == bytes, s"$name: expected $bytes bytes each")
    val length = size.get(JAVA_INT, 0)
    val whole  = at.reinterpret(length.toLong * bytes)
    Array.tabulate(length)(index => read(whole, index.toLong))

  def reset(): Unit =
    check(calls.reset.invokeExact(batch, MemorySegment.NULL, 0, MemorySegment.NULL, 0): Int)

  /** Marks a simulation to be stepped by the next [[step]]. */
  def mark(place: Int): Unit =
    ids.setAtIndex(JAVA_INT, due.toLong, place)
    due += 1

  /** Steps the simulations marked since the last call. */
  def step(): Unit =
    if due > 0 then check(calls.step.invokeExact(batch, ids, due, 1, 0): Int)
    due = 0

  /** Steps all simulations `steps` times, each with its own control in each step (`mjSTATE_CTRL`, count ×
    * steps × its size).
    */
  def rollout(steps: Int, controls: MemorySegment): Unit =
    val none = MemorySegment.NULL
    check(calls.rollout.invokeExact(batch, none, 0, steps, controls, Controls, none, 0): Int)

  private def check(failed: Int): Unit =
    if failed > 0 then
      val reasons = (0 until count).map: place =>
        val text = calls.error.invokeExact(batch, place): MemorySegment
        text.reinterpret(ErrorSize).getString(0)
      throw MujocoFailed(s"MuJoCo: ${reasons.find(_.nonEmpty).getOrElse("failed")}")

/** Thrown when MuJoCo could not step a model. */
private[mujoco] final class MujocoFailed(reason: String) extends IllegalStateException(reason)

private[mujoco] object MujocoBatch:
  /** Makes a batch; MuJoCo copies the model.
    *
    * @return Left says why MuJoCo cannot make it
    */
  def of(model: MemorySegment, count: Int, threads: Int = 1): Either[String, MujocoBatch] =
    val arena  = Arena.ofAuto()
    val config = arena.allocate(8, 4)
    config.set(JAVA_INT, 0, threads)
    val error = arena.allocate(ErrorSize)
    val made  =
      calls.makeBatch.invokeExact(model, count, config, error, ErrorSize.toInt): MemorySegment
    Either.cond(
      made.address != 0,
      new MujocoBatch(NativeMemory.owned(made, arena)(calls.deleteBatch.invokeExact(_): Unit), count, arena),
      error.getString(0).trim
    )

  /** Bits of the parts of the state (`mjtState`). */
  val Time       = 1 << 0
  val Positions  = 1 << 1
  val Velocities = 1 << 2
  val Controls   = 1 << 6

  final case class Part(at: Int, size: Int)

  private val ErrorSize = 1000L
