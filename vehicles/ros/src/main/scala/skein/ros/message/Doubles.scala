package skein.ros.message

import scala.collection.immutable.ArraySeq

/** An array of exactly `N` doubles, such as a covariance row by row: written without its length. */
opaque type Doubles[N <: Int] = ArraySeq[Double]

object Doubles:
  /** @throws IllegalArgumentException for another number of values */
  def of[N <: Int](values: Seq[Double])(using size: ValueOf[N]): Doubles[N] =
    require(values.size == size.value, s"expected ${size.value} numbers, got ${values.size}")
    ArraySeq.from(values)

  /** All zero, which for a covariance means that it is unknown. */
  def zero[N <: Int](using size: ValueOf[N]): Doubles[N] = ArraySeq.fill(size.value)(0.0)

  extension [N <: Int](doubles: Doubles[N]) def values: ArraySeq[Double] = doubles

  given cdr[N <: Int](using size: ValueOf[N]): Cdr[Doubles[N]] =
    Cdr.of[ArraySeq[Double]]((values, to) => to.doubles(values))(_.doubles(size.value))
