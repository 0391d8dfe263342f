package skein.rollout

import skein.signal.SplitMix64

/** One parameter of a policy and the bounds within which it is searched. */
final case class Axis(name: String, least: Double, most: Double):
  require(least < most, s"axis $name: the least value $least must be below the most, $most")

/** The parameters of a family of policies. A candidate has one value per axis, in their order. */
final case class SearchSpace(axes: Vector[Axis]):
  require(axes.nonEmpty, "a search space needs at least one axis")

  def clamp(candidate: Vector[Double]): Vector[Double] =
    candidate.zip(axes).map((value, axis) => value.max(axis.least).min(axis.most))

  /** Evenly spread candidates, `perAxis` values on each axis, both bounds included; the last axis varies fastest. */
  def grid(perAxis: Int): Vector[Vector[Double]] =
    require(perAxis >= 2, s"a grid needs at least 2 values per axis, got $perAxis")
    axes.foldLeft(Vector(Vector.empty[Double])): (candidates, axis) =>
      for
        candidate <- candidates
        i         <- 0 until perAxis
      yield candidate :+ (axis.least + (axis.most - axis.least) * i / (perAxis - 1))

  /** Candidates drawn evenly from the space; the same seed draws the same. */
  def random(count: Int, seed: Long): Vector[Vector[Double]] =
    val source = SplitMix64(seed)
    Vector.fill(count)(axes.map(axis => axis.least + (axis.most - axis.least) * source.nextDouble()))
