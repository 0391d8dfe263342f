package skein.budget

import skein.units.Decimals.significant

/** How far off the truth still counts as holding. */
enum Tolerance:
  /** A share of the truth, for example 0.05. */
  case Share(share: Double)

  /** In the objective's unit: for what may be 0. */
  case Within(distance: Double)

  /** In what deviations are told. */
  def value: Double = this match
    case Share(share)     => share
    case Within(distance) => distance

  /** What deviations are told by; or why they cannot be. */
  def per(truth: Double): Either[String, Double] = this match
    case Share(_) if truth == 0 =>
      Left(
        "it is 0 in the paused truth, so no percentage of it can be given; --within takes a difference instead"
      )
    case _ if !truth.isFinite => Left("it has no value in the paused truth; choose another objective")
    case Share(_)             => Right(truth.abs)
    case Within(_)            => Right(1)

  /** By which deviations are multiplied for people, and the unit that they have then. */
  def shown(unit: String): (Double, String) = this match
    case Share(_)  => (100, "%")
    case Within(_) => (1, unit)

  def text(unit: String): String =
    val (factor, shownUnit) = shown(unit)
    s"${(value * factor).significant(4)} $shownUnit".trim
