package skein.pickle

import scala.compiletime.{constValueTuple, erasedValue, summonAll, summonInline}
import scala.deriving.Mirror
import upickle.core.{Abort, NoOpVisitor, ObjVisitor, StringVisitor, Visitor}
import upickle.default.{ObjectWriter, ReadWriter, SimpleReader, SingletonWriter, TaggedReadWriter}

/** Codec of a case class as a map with a key for each field. Keys may come in any order, unknown keys are
  * skipped, and a key may be missing if its field has a default. Formats are those of upickle's own
  * derivation, for which the compiler needs five times as long.
  *
  * @param omits the fields, by name, that are not written where they have their default
  */
private[skein] class Fields[A](
    mirror: Mirror.ProductOf[A],
    labels: Tuple,
    fields: Tuple,
    omits: String => Boolean = _ => true
) extends SimpleReader[A],
      ObjectWriter[A],
      ReadWriter[A]:
  import Fields.missing

  private val names    = labels.productIterator.map(_.toString).toArray
  private val codecs   = fields.productIterator.map(_.asInstanceOf[ReadWriter[Any]]).toArray
  private val defaults = Fields.defaultsOf(mirror, names.length)
  private val optional = names.indices.filter(i => omits(names(i)) && defaults(i) != missing).toSet

  private def isSingle = names.isEmpty

  /** This codec with another key for a field. */
  def renamed(field: String, key: String): Fields[A] =
    Fields(mirror, Tuple.fromArray(names.map(name => if name == field then key else name)), fields, omits)

  def expectedMsg = "expected dictionary"

  override def visitString(text: CharSequence, index: Int): A =
    if isSingle then mirror.fromProduct(EmptyTuple) else super.visitString(text, index)

  override def visitObject(length: Int, jsonableKeys: Boolean, index: Int): ObjVisitor[Any, A] =
    new ObjVisitor[Any, A]:
      private val values = defaults.clone
      private var at     = -1

      def visitKey(index: Int)               = StringVisitor
      def visitKeyValue(key: Any)            = at = names.indexOf(key.toString)
      def subVisitor                         = if at < 0 then NoOpVisitor else codecs(at)
      def visitValue(value: Any, index: Int) = if at >= 0 then values(at) = value
      def visitEnd(index: Int)               =
        val absent = names.indices.filter(values(_) == missing).map(names(_))
        if absent.nonEmpty then throw Abort(s"missing keys in dictionary: ${absent.mkString(", ")}")
        mirror.fromProduct(Tuple.fromArray(values))

  def length(value: A): Int =
    names.length - optional.count(field =>
      value.asInstanceOf[Product].productElement(field) == defaults(field)
    )

  def writeToObject[V](map: ObjVisitor[?, V], value: A): Unit =
    val into = map.narrow
    val each = value.asInstanceOf[Product]
    for i <- 0 until names.length do
      val field = each.productElement(i)
      if !(optional.contains(i) && field == defaults(i)) then
        into.visitKeyValue(into.visitKey(-1).visitString(names(i), -1))
        into.visitValue(codecs(i).write(into.subVisitor, field), -1)

  def write0[V](out: Visitor[?, V], value: A): V =
    val map = out.visitObject(length(value), true, -1)
    writeToObject(map, value)
    map.visitEnd(-1)

private[skein] object Fields:
  private val missing = new Object

  inline def derived[A](using mirror: Mirror.ProductOf[A]): Fields[A] =
    Fields(
      mirror,
      constValueTuple[mirror.MirroredElemLabels],
      summonAll[Tuple.Map[mirror.MirroredElemTypes, ReadWriter]]
    )

  /** Codec of a sealed type: a case's fields after its name as `$type`, or its name alone if it has none. */
  inline def ofCases[A](using mirror: Mirror.SumOf[A]): ReadWriter[A] =
    tagged(mirror, constValueTuple[mirror.MirroredElemLabels], cases[mirror.MirroredElemTypes])

  private inline def cases[T <: Tuple]: List[Fields[?]] = inline erasedValue[T] match
    case _: EmptyTuple     => Nil
    case _: (head *: tail) => derived[head](using summonInline[Mirror.ProductOf[head]]) :: cases[tail]

  def tagged[A](mirror: Mirror.SumOf[A], labels: Tuple, cases: List[Fields[?]]): ReadWriter[A] =
    val names  = labels.productIterator.toVector
    val codecs = cases.toVector.asInstanceOf[Vector[Fields[A]]]
    new TaggedReadWriter[A]:
      def findReader(name: String)      = codecs.lift(names.indexOf(name)).orNull
      def findWriterWithKey(value: Any) =
        val each   = value.asInstanceOf[A]
        val number = mirror.ordinal(each)
        (
          "$type",
          names(number).toString,
          if codecs(number).isSingle then SingletonWriter(each) else codecs(number)
        )

  /** The compiler makes the mirror of a case class its companion, with a method for each default. */
  private def defaultsOf(companion: Any, size: Int): Array[Any] =
    val methods = companion.getClass.getMethods.map(method => method.getName -> method).toMap
    Array.tabulate(size): i =>
      methods.get(s"$$lessinit$$greater$$default$$${i + 1}").fold[Any](missing)(_.invoke(companion))
