package skein.budget

import skein.units.Decimals.significant

/** The greatest deviation from the paused loop that counts as tolerated. */
enum Tolerance:
  /** A fraction of the paused loop's value, for example 0.05 for 5 %. */
  case Share(share: Double)

  /** A distance in the objective's unit: for objectives that may be 0. */
  case Within(distance: Double)

  /** The tolerance as a number, in the unit of deviations. */
  def value: Double = this match
    case Share(share)     => share
    case Within(distance) => distance

  /** The divisor of deviations; Left says why there is none. */
  def per(truth: Double): Either[String, Double] = this match
    case Share(_) if truth == 0 =>
      Left(
        "it is 0 in the paused truth, so no percentage of it can be given; --within takes a difference instead"
      )
    case _ if !truth.isFinite => Left("it has no value in the paused truth; choose another objective")
    case Share(_)             => Right(truth.abs)
    case Within(_)            => Right(1)

  /** The factor that scales deviations for display, with the unit that they then have. */
  def shown(unit: String): (Double, String) = this match
    case Share(_)  => (100, "%")
    case Within(_) => (1, unit)

  def text(unit: String): String =
    val (factor, shownUnit) = shown(unit)
    s"${(value * factor).significant(4)} $shownUnit".trim

object Tolerance:
  /** Reads the options `--tolerance`, in per cent, and `--within`; without either, 5 %. */
  def read(percent: Option[Double], within: Option[Double]): Either[String, Tolerance] =
    (percent, within) match
      case (None, Some(distance)) =>
        Either.cond(
          distance > 0 && distance.isFinite,
          Tolerance.Within(distance),
          s"--within: expected a number above 0, got $distance"
        )
      case (share, None) =>
        val percent = share.getOrElse(5.0)
        Either.cond(
          percent > 0 && percent <= 1000,
          Tolerance.Share(percent / 100),
          s"--tolerance: expected more than 0 %, got $percent"
        )
      case _ => Left("--tolerance, --within: expected one of them")
