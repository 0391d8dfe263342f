package skein.simd

import scala.collection.mutable

/** Numbers the inputs of expressions by what they stand for, from `first` on. Mutable.
  *
  * @tparam S what an input stands for
  */
private[skein] final class Sources[S](first: Int = 0):
  private val numbers = mutable.HashMap.empty[S, Int]
  private val all     = mutable.ArrayBuffer.empty[S]

  def inputOf(source: S): Int = numbers.getOrElseUpdate(
    source, {
      all += source
      first + all.size - 1
    }
  )

  def apply(input: Int): S = all(input - first)
