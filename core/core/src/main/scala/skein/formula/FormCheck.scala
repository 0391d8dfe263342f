package skein.formula

import scala.collection.mutable

/** Checks whether objects have one form, by the values at certain paths inside them. */
private final class FormCheck(guards: Vector[Guard]):
  private val walk     = PathWalk(guards.map(_.path))
  private val expected = guards.map(_.expected).toArray

  def fits(root: AnyRef): Boolean =
    val found = walk(root)
    var i     = 0
    while i < expected.length && holds(expected(i), found(walk.places(i))) do i += 1
    i == expected.length

  private def holds(expected: Any, value: AnyRef): Boolean = expected match
    case null                => value == null
    case kind: Class[?]      => value != null && (value.getClass eq kind)
    case Guard.Length(count) => value != null && java.lang.reflect.Array.getLength(value) == count
    case number              => value == number

/** Reads numbers at certain paths inside objects of one form. Reads arrays directly, without an object per
  * number, since networks have hundreds of numbers.
  */
private final class NumberReader(paths: Vector[Path]):
  private val walk    = PathWalk(paths.map(path => if indexOf(path) < 0 then path else path.before.get))
  private val indices = paths.map(indexOf).toArray
  private def indexOf(of: Path) = of.step match
    case PathStep.At(index) => index
    case _                  => -1

  def read(root: AnyRef): Array[Double] =
    val found   = walk(root)
    val numbers = Array.ofDim[Double](indices.length)
    var i       = 0
    while i < numbers.length do
      val index = indices(i)
      numbers(i) = found(walk.places(i)) match
        case several: Array[Double] if index >= 0 => several(index)
        case several if index >= 0                => unboxed(java.lang.reflect.Array.get(several, index))
        case number                               => unboxed(number)
      i += 1
    numbers

  private def unboxed(number: AnyRef) = number.asInstanceOf[java.lang.Double].doubleValue

/** Reads the values at certain paths inside an object; visits each object on the way only once. */
private final class PathWalk(paths: Vector[Path]):
  private val all                  = mutable.LinkedHashMap.empty[Path, Int]
  private def place(of: Path): Int =
    of.before.foreach(place)
    all.getOrElseUpdate(of, all.size)

  /** For each path, the index of its value in the result of [[apply]]. */
  val places: Array[Int] = paths.map(place).toArray

  private val steps  = all.keysIterator.map(_.step).toArray
  private val before = all.keysIterator.map(_.before.fold(-1)(all)).toArray
  for case PathStep.Of(field) <- steps do field.setAccessible(true)

  /** Reads the values at all paths; null if the object does not have the form. */
  def apply(root: AnyRef): Array[AnyRef] =
    val found = Array.ofDim[AnyRef](steps.length)
    var i     = 0
    while i < steps.length do
      val from = if before(i) < 0 then root else found(before(i))
      found(i) = steps(i) match
        case PathStep.Itself      => root
        case PathStep.Argument(_) => throw IllegalArgumentException("an argument is no part of the object")
        case _ if from == null    => null
        case PathStep.Of(field)   =>
          if field.getDeclaringClass.isInstance(from) then field.get(from) else null
        case PathStep.At(index) =>
          if index < java.lang.reflect.Array.getLength(from) then java.lang.reflect.Array.get(from, index)
          else null
      i += 1
    found
