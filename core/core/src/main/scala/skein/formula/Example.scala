package skein.formula

import java.lang.reflect.Modifier
import scala.collection.mutable

/** An example of an argument, for tracing. Every double in it becomes an input. Every long is a duration in
  * nanoseconds; its seconds become an input. Everything else is a constant.
  *
  * @param takesWholes whether integers and booleans become inputs too, and longs are refused; those inside
  *   Scala's own collections stay constant
  * @param refused fields that must not be read, as `Class.field`, each with the reason
  */
final class Example(
    val name: String,
    val value: AnyRef,
    takesWholes: Boolean = false,
    val refused: Map[String, String] = Map.empty
):
  private[formula] val root = Path(None, PathStep.Argument(name))

  /** @throws Untraceable if the example contains something that cannot be represented by numbers
    */
  private[formula] lazy val shape: Shape = Shape(this, takesWholes)

  /** The example's numbers, in the order of the inputs. */
  def numbers: Vector[Double] = shape.leaves.map(_.number)

  /** Whether another example differs from this one only in its numbers. */
  def isLike(other: Example): Boolean = shape.form == other.shape.form

/** The numbers of an [[Example]], and the constants that all similar examples share. */
private[formula] final class Shape(of: Example, takesWholes: Boolean):
  private val found   = Vector.newBuilder[Shape.Leaf]
  private val alike   = Vector.newBuilder[(Path, Any)]
  private val visited = mutable.HashSet.empty[Path]
  visit(of.value, of.root, isLibrary = false, depth = 0)

  val leaves: Vector[Shape.Leaf] = found.result()

  /** For each path, the class of the object there, or the constant. */
  val form: Vector[(Path, Any)] = alike.result()

  private def visit(value: AnyRef, at: Path, isLibrary: Boolean, depth: Int): Unit =
    if depth > Shape.MostDepth || visited.size > Shape.MostParts then
      throw Untraceable(s"${of.name} is of too many parts")
    visited += at
    def known(what: Any): Unit     = alike += at -> what
    def leaf(number: Double): Unit =
      known(value.getClass)
      found += Shape.Leaf(at, number)
    value match
      case null                     => known(null)
      case number: java.lang.Double => leaf(number)
      case _: java.lang.Float       => throw Untraceable(s"$at is a float; formulas are written in doubles")
      case number: java.lang.Long   =>
        if isLibrary then known(number)
        else if takesWholes then
          throw Untraceable(
            s"$at is a long, which may count or measure time; keep seconds as a double, or an int"
          )
        else leaf(number.doubleValue)
      case simple: (java.lang.Integer | java.lang.Short | java.lang.Byte | java.lang.Boolean) =>
        if takesWholes && !isLibrary then leaf(Value.wholeOf(simple)) else known(simple)
      case text: (String | java.lang.Character | Class[?]) => known(text)
      case _ if value.getClass.isArray                     =>
        val size = java.lang.reflect.Array.getLength(value)
        known((value.getClass, size))
        for i <- 0 until size do
          visit(java.lang.reflect.Array.get(value, i), Path(Some(at), PathStep.At(i)), isLibrary, depth + 1)
      case _ =>
        known(value.getClass)
        for field <- Shape.fieldsOf(value.getClass) do
          val name = s"${field.getDeclaringClass.getSimpleName}.${field.getName}"
          if !of.refused.contains(name) then
            val way = Path(Some(at), PathStep.Of(field))
            visit(Shape.read(field, value), way, Shape.isInternal(field), depth + 1)

private[formula] object Shape:
  /** A number in an example, and the path to it. */
  final case class Leaf(path: Path, number: Double)

  private val MostDepth = 60
  private val MostParts = 100_000

  /** The fields of a class that tracing reads, in the order of declaration; those of superclasses are first.
    */
  def fieldsOf(kind: Class[?]): Vector[java.lang.reflect.Field] =
    Iterator
      .iterate[Class[?]](kind)(_.getSuperclass)
      .takeWhile(each => each != null && each != classOf[Object])
      .toVector
      .reverse
      .flatMap(_.getDeclaredFields.filterNot(each => Modifier.isStatic(each.getModifiers)))

  def read(field: java.lang.reflect.Field, of: AnyRef): AnyRef =
    if field.trySetAccessible() then field.get(of)
    else throw Untraceable(s"${field.getDeclaringClass.getName} is not made of numbers")

  /** Whether a field belongs to a library class, like the size of a collection. */
  def isInternal(field: java.lang.reflect.Field): Boolean =
    field.getType.isPrimitive && ClassFiles.isLibrary(ClassFiles.nameOf(field.getDeclaringClass)) &&
      !field.getDeclaringClass.getName.startsWith("scala.Tuple")
