package skein.policy

import skein.signal.SplitMix64

/** One parameter of a policy: the bounds within which it is searched, and the value it has when none is given.
  *
  * @param name
  *   with its unit, for example `turnRateRadPerS`; the same in files and on the command line
  */
final case class Axis(name: String, least: Double, most: Double, default: Double):
  require(least < most, s"axis $name: the least value $least must be below the most, $most")
  require(
    least <= default && default <= most,
    s"axis $name: the default $default must lie between $least and $most"
  )

  def width: Double = most - least

object Axis:
  /** With the default in the middle. */
  def apply(name: String, least: Double, most: Double): Axis = Axis(name, least, most, (least + most) / 2)

/** The parameters of a family of policies. A candidate has one value per axis, in their order. */
final case class SearchSpace(axes: Vector[Axis]):
  require(axes.nonEmpty, "a search space needs at least one axis")
  require(
    axes.map(_.name).distinct.size == axes.size,
    s"axes need names of their own, got ${axes.map(_.name)}"
  )

  def dimension: Int = axes.size

  def defaults: Vector[Double] = axes.map(_.default)

  def clamp(candidate: Vector[Double]): Vector[Double] =
    candidate.zip(axes).map((value, axis) => value.max(axis.least).min(axis.most))

  /** Evenly spread candidates, `perAxis` values on each axis, both bounds included; the last axis varies fastest. */
  def grid(perAxis: Int): Vector[Vector[Double]] =
    require(perAxis >= 2, s"a grid needs at least 2 values per axis, got $perAxis")
    axes.foldLeft(Vector(Vector.empty[Double])): (candidates, axis) =>
      for
        candidate <- candidates
        i         <- 0 until perAxis
      yield candidate :+ (axis.least + axis.width * i / (perAxis - 1))

  /** Candidates drawn evenly from the space; the same seed draws the same. */
  def random(count: Int, seed: Long): Vector[Vector[Double]] =
    val source = SplitMix64(seed)
    Vector.fill(count)(axes.map(axis => axis.least + axis.width * source.nextDouble()))
