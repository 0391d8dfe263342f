package skein.formula

import java.lang.constant.ClassDesc
import scala.collection.mutable
import skein.formula.Thing.*
import skein.formula.Value.*

/** Represents objects and arrays during tracing. Those that the method creates exist only here; earlier ones
  * are read and never changed. A double that is read from the method's own object becomes a parameter. Every
  * other value that is read from it must be equal in another object ([[guards]]) for both to share the trace.
  */
private[formula] final class Objects(
    files: ClassFiles,
    trace: Trace,
    numbers: Arithmetic,
    refuse: String => Nothing
):
  import Objects.*
  import numbers.{decided, known, noFloats, settled}

  private var heap   = Map.empty[Int, Thing]
  private var made   = 0
  private val params = mutable.LinkedHashMap.empty[Path, Node]
  private val alike  = mutable.LinkedHashMap.empty[Guard, Unit]

  // Of the arguments' examples: the nodes of their numbers, and the reasons why fields must not be read.
  private val inputs  = mutable.HashMap.empty[Path, Node]
  private val unknown = mutable.HashMap.empty[String, String]

  /** Indices of the objects that were changed, one entry per change. */
  private val changed = mutable.ArrayBuffer.empty[Int]

  /** Paths to the doubles that were read from the method's object, in the order of the trace's parameters. */
  def parameters: Vector[Path] = params.keys.toVector

  /** The values that must be equal in another object for it to share the trace. */
  def guards: Vector[Guard] = alike.keys.toVector

  def thing(id: Int): Thing = heap(id)

  def make(thing: Thing): Value =
    made += 1
    heap += made -> thing
    Made(made)

  /** Represents an argument by its example.
    *
    * @param input creates the input for the number at a path
    */
  def argument(of: Example, input: Path => Node): Value =
    for leaf <- of.shape.leaves do inputs(leaf.path) = input(leaf.path)
    unknown ++= of.refused
    held(of.value, Some(of.root), classOf[Object])

  private def change(id: Int, thing: Thing): Unit =
    heap += id -> thing
    changed += id

  /** A snapshot of all objects created so far. */
  def now: Moment = Moment(heap, changed.size)

  def backTo(moment: Moment): Unit = heap = moment.things

  /** Joins the objects as two branches have left them. Create it at the end of the second branch. */
  final class Merge(condition: Node, parted: Moment, first: Moment):
    private val (yes, no) = (first.things, heap)
    private val pairs     = mutable.HashMap.empty[(Value, Value), Value]
    heap = yes ++ no

    /** Joins the objects that existed before the branches separated. */
    def things(): Unit =
      for id <- changed.drop(parted.changes).distinct; a <- yes.get(id); b <- no.get(id) if a != b do
        change(
          id,
          (a, b) match
            case (Record(name, of), Record(_, or))        => Record(name, fields(of, or))
            case (Fields(name, of), Fields(_, or))        => Thing.Either(name, fields(of, or))
            case (Elements(of, one), Elements(or, other)) =>
              Elements(of.zip(or).map(value), one || other)
            case _ => a
        )

    private def fields(a: Map[String, Value], b: Map[String, Value]): Map[String, Value] =
      (a.keySet ++ b.keySet).iterator
        .map: name =>
          name -> ((a.get(name), b.get(name)) match
            case (Some(one), Some(other)) => value(one, other)
            case (one, other) => value(one.getOrElse(zeroOf(other.get)), other.getOrElse(zeroOf(one.get))))
        .toMap

    def value(a: Value, b: Value): Value = numbers.either(condition, a, b) match
      case _: OneOf => pairs.getOrElseUpdate((a, b), ofThings(a, b))
      case one      => one

    private def ofThings(a: Value, b: Value): Value = (thingOf(a, yes), thingOf(b, no)) match
      case (Some(one), Some(other)) =>
        // A later change of either would not be seen in the joint object.
        for case Made(id) <- Seq(a, b) do freeze(id)
        alikeOf(one, other) match
          case (Fields(of, x), Fields(or, y)) if of == or           => make(Thing.Either(of, fields(x, y)))
          case (Elements(x, _), Elements(y, _)) if x.size == y.size =>
            make(Elements(x.zip(y).map(value), isFrozen = true))
          case _ => OneOf(condition, a, b)
      case _ => OneOf(condition, a, b)

    /** An object that the method created, or a copy of an earlier case class of doubles; None for other
      * objects.
      */
    private def thingOf(of: Value, in: Map[Int, Thing]): Option[Thing] = of match
      case Made(id)                                                                        => Some(in(id))
      case Known(what, path) if !path.exists(_.isOfArgument) && isOfDoubles(what.getClass) =>
        val fields = doublesOf(what.getClass).map: field =>
          val way = path.map(before => Path(Some(before), PathStep.Of(field)))
          field.getName -> held(open(field).get(what), way, field.getType)
        Some(Record(ClassFiles.nameOf(what.getClass), fields.toMap))
      case _ => None

    /** Converts a specialised tuple to the generic class if the other branch has the generic one, for example
      * because one of its numbers is a constant.
      */
    private def alikeOf(a: Thing, b: Thing): (Thing, Thing) = (a, b) match
      case (Fields(of, _), Fields(or, _)) if of != or => (unspecialised(a), unspecialised(b))
      case _                                          => (a, b)

    private def unspecialised(thing: Thing): Thing = thing match
      case Record(Specialised(of), fields)       => Record(of, boxed(fields))
      case Thing.Either(Specialised(of), fields) => Thing.Either(of, boxed(fields))
      case other                                 => other

    private def boxed(fields: Map[String, Value]) = fields.collect:
      case (SpecialisedField(name), value) => name -> Boxed(value)

  def put(of: Value, name: String, value: Value): Unit = of match
    case Made(id) => heap(id) match
        case Record(className, fields) => change(id, Record(className, fields + (name -> value)))
        case _                         => refuse("it changes one of two objects, as a condition decides")
    case _ => refuse(s"it changes $name of an object that was there before; a formula changes nothing")

  def static(owner: String, name: String): Value =
    val field = found(files.load(owner), name)
    if !java.lang.reflect.Modifier.isFinal(field.getModifiers) && !ClassFiles.isLibrary(owner) then
      refuse(s"it reads the variable $name, which everybody shares")
    held(open(field).get(null), None, field.getType)

  def fieldOf(of: Value, name: String, kind: ClassDesc): Value = settled(of) match
    case OneOf(condition, yes, no) => one(condition, fieldOf(yes, name, kind), fieldOf(no, name, kind))
    case Made(id)                  => heap(id) match
        case Fields(_, fields) => fields.getOrElse(name, zeroOf(kind))
        case _                 => refuse(s"it reads $name of an array or a closure")
    case Known(what, path) =>
      val field = found(what.getClass, name)
      if !java.lang.reflect.Modifier.isFinal(field.getModifiers) && !ClassFiles.isLibrary(
          ClassFiles.nameOf(what.getClass)
        )
      then
        refuse(s"it reads the variable $name; a formula's object has values alone")
      val refused =
        path.filter(_.isOfArgument).flatMap(_ =>
          unknown.get(s"${field.getDeclaringClass.getSimpleName}.$name")
        )
      refused match
        case Some(reason) => Unreadable(reason, field.getType == classOf[scala.Long])
        case None         =>
          val value = open(field).get(what)
          held(value, path.map(way => Path(Some(way), PathStep.Of(field))), field.getType)
    case Null => refuse(s"it reads $name of nothing")
    case _    => refuse(s"it reads $name of a number")

  private def freeze(id: Int): Unit = heap(id) match
    case Record(name, fields)    => change(id, Thing.Either(name, fields))
    case Elements(values, false) => change(id, Elements(values, isFrozen = true))
    case _                       => ()

  /** Joins two values of the present state by a condition. */
  private def one(condition: Node, a: Value, b: Value): Value = Merge(condition, now, now).value(a, b)

  /** What a field holds that one branch has not written, where the other has written this. */
  private def zeroOf(written: Value): Value = settled(written) match
    case _: Number        => Number(trace.const(0))
    case _: Whole         => Whole(trace.const(0))
    case _: (Long | Time) => Long(0)
    case OneOf(_, a, _)   => zeroOf(a)
    case _                => Null

  private def zeroOf(kind: ClassDesc): Value = kind.descriptorString match
    case "D"                      => Number(trace.const(0))
    case "J"                      => Long(0)
    case "F"                      => noFloats()
    case text if text.length == 1 => Whole(trace.const(0))
    case _                        => Null

  private val fields = mutable.HashMap.empty[(Class[?], String), java.lang.reflect.Field]

  private def found(in: Class[?], name: String): java.lang.reflect.Field = fields.getOrElseUpdate(
    (in, name),
    Iterator
      .iterate[Class[?]](in)(_.getSuperclass)
      .takeWhile(_ != null)
      .flatMap(each => each.getDeclaredFields.find(_.getName == name))
      .nextOption()
      .getOrElse(refuse(s"${in.getName} has no field $name"))
  )

  private def open(field: java.lang.reflect.Field): java.lang.reflect.Field =
    if field.trySetAccessible() then field
    else refuse(s"it uses ${field.getDeclaringClass.getName}, which is not arithmetic")

  /** Represents a value inside an object that existed before tracing. */
  private def held(value: AnyRef, path: Option[Path], kind: Class[?]): Value =
    def alikeIn(expected: Any): Unit = path.foreach(way => guard(way, expected))
    path.flatMap(inputs.get).fold(heldItself(value, path, kind, alikeIn)): node =>
      val number = value match
        case _: java.lang.Double  => Number(node)
        case _: java.lang.Long    => Time(node)
        case _: java.lang.Boolean =>
          val isSet = trace.not(trace.equal(node, trace.const(0)))
          Whole(numbers.asNumber(isSet))
        case _ => Whole(node)
      if kind.isPrimitive then number else Boxed(number)

  /** Requires a constant to be equal in other objects; constants of arguments are already fixed by their
    * example.
    */
  private def guard(way: Path, expected: Any): Unit =
    if !way.isOfArgument then alike(Guard(way, expected)) = ()

  private def heldItself(
      value: AnyRef,
      path: Option[Path],
      kind: Class[?],
      alikeIn: Any => Unit
  ): Value =
    value match
      case null                     => alikeIn(null); Null
      case number: java.lang.Double =>
        val node =
          path.fold(trace.const(number))(way => params.getOrElseUpdate(way, trace.param(params.size)))
        if kind == classOf[Double] then Number(node)
        else
          alikeIn(number.getClass)
          Boxed(Number(node))
      case _: java.lang.Float     => noFloats()
      case number: java.lang.Long =>
        alikeIn(number)
        if kind == classOf[scala.Long] then Long(number) else Boxed(Long(number))
      case simple: (java.lang.Integer | java.lang.Short | java.lang.Byte | java.lang.Boolean |
            java.lang.Character) =>
        alikeIn(simple)
        val node = Whole(trace.const(wholeOf(simple)))
        if kind.isPrimitive then node else Boxed(node)
      case text: String => alikeIn(text); Known(text, None)
      // Cases of an enum without fields share a class.
      case single: (scala.reflect.Enum | java.lang.Enum[?]) if !isOfFields(single) =>
        alikeIn(single)
        Known(single, path)
      case other => alikeIn(other.getClass); Known(other, path)

  private def isOfFields(of: AnyRef) = of match
    case product: Product => product.productArity > 0
    case _                => false

  /** The element at an index. If the index is unknown, conditions choose among all elements. */
  def elementAt(array: Value, index: Node): Value =
    if index.isConst then element(array, index.value.toInt)
    else if index.op == Op.Where then
      val Vector(condition, yes, no) = index.args
      one(condition, elementAt(array, yes), elementAt(array, no))
    else refuse("an index that depends on what is observed")

  def element(array: Value, index: Int): Value = settled(array) match
    case OneOf(condition, yes, no) => one(condition, element(yes, index), element(no, index))
    case Made(id)                  => heap(id) match
        case Elements(values, _) if values.indices.contains(index) => values(index)
        case Elements(values, _) => refuse(s"index $index of an array of ${values.size}")
        case _                   => refuse("an element of what is no array")
    case Known(what, path) if what.getClass.isArray =>
      val size = java.lang.reflect.Array.getLength(what)
      if index < 0 || index >= size then refuse(s"index $index of an array of $size")
      val way = path.map(before => Path(Some(before), PathStep.At(index)))
      held(java.lang.reflect.Array.get(what, index), way, what.getClass.getComponentType)
    case _ => refuse("an element of what is no array")

  def update(array: Value, index: Int, value: Value): Unit = decided(array) match
    case Made(id) => heap(id) match
        case Elements(values, false) if values.indices.contains(index) =>
          change(id, Elements(values.updated(index, fitting(values(index), value))))
        case Elements(values, false) => refuse(s"index $index of an array of ${values.size}")
        case _                       => refuse("it changes one of two arrays, as a condition decides")
    case _ => refuse("it changes an array that was there before; a formula changes nothing")

  /** Converts a value to the representation of the array element that it replaces. */
  private def fitting(before: Value, value: Value): Value = (before, value) match
    case (_: (Number | Whole | Long | Time), Boxed(inner)) => inner
    case (_: (Number | Whole | Long | Time), _)            => value
    case _                                                 => inObject(value)

  def inObject(value: Value): Value = value match
    case _: (Number | Whole | Long | Time) => Boxed(value)
    case _                                 => value

  def lengthOf(array: Value): Int = settled(array) match
    case OneOf(_, yes, no) =>
      val length = lengthOf(yes)
      if lengthOf(no) == length then length else refuse("a length that depends on what is observed")
    case Made(id) => heap(id) match
        case Elements(values, _) => values.size
        case _                   => refuse("the length of what is no array")
    case Known(what, path) if what.getClass.isArray =>
      val size = java.lang.reflect.Array.getLength(what)
      path.foreach(way => guard(way, Guard.Length(size)))
      size
    case _ => refuse("the length of what is no array")

  def classOfThing(value: Value): Option[String] = value match
    case Made(id) => heap(id) match
        case Fields(name, _)             => Some(name)
        case Closure(interface, _, _, _) => Some(interface)
        case _                           => None
    case Known(what, _)   => Some(ClassFiles.nameOf(what.getClass))
    case Boxed(Number(_)) => Some("java/lang/Double")
    case Boxed(Whole(_))  => Some("java/lang/Integer")
    case Boxed(_)         => Some("java/lang/Long")
    case _                => None

  def isA(value: Value, name: String): Boolean = decided(value) match
    case Null                                        => false
    case Made(id) if heap(id).isInstanceOf[Elements] =>
      heap(id).asInstanceOf[Elements].values.headOption match
        case Some(_: Number) => name == "[D"
        case Some(_: Whole)  => name == "[I"
        case _               => name == "[Ljava/lang/Object;"
    case Known(what, _) => files.load(name.replace('/', '.')).isInstance(what)
    case other          =>
      classOfThing(other).exists(own => files.load(name).isAssignableFrom(files.load(own)))

  /** Copies array elements like `System.arraycopy`, or like Scala's `Array.copy`, which boxes numbers. */
  def copied(args: Vector[Value]): Option[Value] =
    val Vector(fromAt, toAt, count) = Vector(1, 3, 4).map(i => known(args(i), "an index"))
    decided(args(2)) match
      case Made(id) => heap(id) match
          case Elements(values, false) =>
            val copy = Vector.tabulate(count)(i => fitting(values(toAt + i), element(args(0), fromAt + i)))
            change(id, Elements(values.patch(toAt, copy, count)))
            Some(Null)
          case _ => refuse("it changes one of two arrays, as a condition decides")
      case _ => refuse("it changes an array that was there before; a formula changes nothing")

private[formula] object Objects:
  /** A snapshot of the objects made so far, with the number of changes. */
  final case class Moment(things: Map[Int, Thing], changes: Int)

  /** The class and the fields of an object, whether it may be changed or not. */
  private object Fields:
    def unapply(thing: Thing): Option[(String, Map[String, Value])] = thing match
      case Thing.Record(name, fields) => Some((name, fields))
      case Thing.Either(name, fields) => Some((name, fields))
      case _                          => None

  /** Scala's specialised tuple classes, and their fields. */
  private val Specialised      = """(scala/Tuple[12])\$mc[A-Z]+\$sp""".r
  private val SpecialisedField = """(\w+)\$mc[A-Z]\$sp""".r

  private def doublesOf(kind: Class[?]): Vector[java.lang.reflect.Field] =
    kind.getDeclaredFields.toVector.filterNot(each => java.lang.reflect.Modifier.isStatic(each.getModifiers))

  private def isOfDoubles(kind: Class[?]): Boolean =
    classOf[Product].isAssignableFrom(kind) && kind.getSuperclass == classOf[Object] &&
      doublesOf(kind).forall(each => each.getType == classOf[Double] || isOfDoubles(each.getType))

/** A requirement on an object: the value at the end of a path must be a certain class, a number, null, or a
  * [[Guard.Length]].
  */
private[formula] final case class Guard(path: Path, expected: Any)

private[formula] object Guard:
  final case class Length(value: Int)
