package skein.policy

import skein.signal.SplitMix64

/** One parameter of a policy: the bounds of a search, and the default value.
  *
  * @param name its name with the unit, for example `turnRateRadPerS`; used in files and on the command line
  */
final case class Axis(name: String, least: Double, most: Double, default: Double):
  require(least < most, s"axis $name: the least value $least must be below the most, $most")
  require(
    least <= default && default <= most,
    s"axis $name: the default $default must lie between $least and $most"
  )

  def width: Double = most - least

  /** Distance of a value from the nearer bound, divided by the width. */
  def margin(value: Double): Double = (value - least).min(most - value) / width

object Axis:
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

  /** Number of candidates that [[gridAt]] enumerates. */
  def gridSize(perAxis: Int): Long =
    axes.foldLeft(1L)((product, _) => Math.multiplyExact(product, perAxis.toLong))

  /** A candidate of an even grid with `perAxis` values on each axis, both bounds included. The last axis
    * varies fastest.
    */
  def gridAt(perAxis: Int, index: Long): Vector[Double] =
    require(perAxis >= 2, s"a grid needs at least 2 values per axis, got $perAxis")
    val places = axes.indices.reverse.scanLeft(index)((rest, _) => rest / perAxis).map(_ % perAxis)
    axes
      .zip(places.take(dimension).reverse)
      .map((axis, place) => axis.least + axis.width * place / (perAxis - 1))

  def grid(perAxis: Int): Vector[Vector[Double]] =
    Vector.tabulate(gridSize(perAxis).toInt)(gridAt(perAxis, _))

  /** A candidate drawn uniformly from the space, one of an unlimited sequence. Equal seeds and indices give
    * equal candidates.
    */
  def randomAt(seed: Long, index: Long): Vector[Double] =
    val source = SplitMix64(SplitMix64.seedOf(seed, index))
    axes.map(axis => axis.least + axis.width * source.nextDouble())

  def random(count: Int, seed: Long): Vector[Vector[Double]] = Vector.tabulate(count)(randomAt(seed, _))

  /** The candidate at a position relative to the bounds: a share from 0 to 1 of each axis. Shares outside are
    * mirrored at the bounds, so that every vector represents a candidate, and neighbouring vectors
    * neighbouring candidates.
    */
  def at(shares: Vector[Double]): Vector[Double] =
    shares.zip(axes).map((share, axis) => axis.least + axis.width * SearchSpace.mirrored(share))

  /** The inverse of [[at]] for candidates within the bounds. */
  def shares(candidate: Vector[Double]): Vector[Double] =
    candidate.zip(axes).map((value, axis) => (value - axis.least) / axis.width)

object SearchSpace:
  private def mirrored(share: Double): Double =
    val turn = share - 2 * math.floor(share / 2)
    if turn > 1 then 2 - turn else turn
