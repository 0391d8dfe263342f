package skein.formula

import java.lang.reflect.Modifier
import scala.collection.mutable

/** What an argument is like while a method is traced: every double in it is an input, and every long a length
  * of time in nanoseconds, of which the input are the seconds. What else is in it, is so.
  *
  * @param takesWholes whether integers and truths are inputs too, and longs are refused; those in Scala's own
  *   collections are known all the same
  * @param refused fields that are not to be read, as `Class.field`, and why
  */
final class Example(
    val name: String,
    val value: AnyRef,
    takesWholes: Boolean = false,
    val refused: Map[String, String] = Map.empty
):
  private[formula] val root = Path(None, PathStep.Argument(name))

  /** @throws Untraceable if there is something that no number can stand for
    */
  private[formula] lazy val shape: Shape = Shape(this, takesWholes)

  /** Its numbers, in the order in which they are inputs. */
  def numbers: Vector[Double] = shape.leaves.map(_.number)

  /** Whether another one differs in numbers alone. */
  def isLike(other: Example): Boolean = shape.form == other.shape.form

/** The numbers of an [[Example]], and what is the same in all that are like it. */
private[formula] final class Shape(of: Example, takesWholes: Boolean):
  private val found   = Vector.newBuilder[Shape.Leaf]
  private val alike   = Vector.newBuilder[(Path, Any)]
  private val visited = mutable.HashSet.empty[Path]
  visit(of.value, of.root, isLibrary = false, depth = 0)

  val leaves: Vector[Shape.Leaf] = found.result()

  /** By way: the class that stands there, or what is known. */
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
  /** A number in an example, and the way to it. */
  final case class Leaf(path: Path, number: Double)

  private val MostDepth = 60
  private val MostParts = 100_000

  /** Superclasses' first. */
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

  /** Whether numbers of this field are a library's own, as a collection's size is. */
  def isInternal(field: java.lang.reflect.Field): Boolean =
    field.getType.isPrimitive && ClassFiles.isLibrary(ClassFiles.nameOf(field.getDeclaringClass)) &&
      !field.getDeclaringClass.getName.startsWith("scala.Tuple")
