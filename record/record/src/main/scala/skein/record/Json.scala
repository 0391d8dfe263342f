package skein.record

/** Writes JSON; no input can fail. */
private[record] object Json:

  def string(text: String): String =
    val out = StringBuilder("\"")
    text.foreach:
      case '"'                                                  => out ++= "\\\""
      case '\\'                                                 => out ++= "\\\\"
      case other if other < ' ' || Character.isSurrogate(other) =>
        out ++= s"\\u${(0x10000 | other).toHexString.drop(1)}"
      case other => out += other
    out.append('"').toString

  /** @param number finite, as all numbers of a recording are */
  def number(number: Double): String = number.toString

  def array(values: Iterable[String]): String = values.mkString("[", ",", "]")

  def obj(fields: (String, String)*): String =
    fields.map((name, value) => s"${string(name)}:$value").mkString("{", ",", "}")

/** Writes a row as a JSON object whose keys are the column names; an absent value is left out. */
private[record] final class JsonRow(columns: Vector[Column]) extends RowWriter:
  private val fields = Vector.newBuilder[(String, String)]
  private val names  = columns.iterator.map(_.name)

  private def put(value: String): Unit = fields += names.next() -> value

  def text(value: String): Unit             = put(Json.string(value))
  def long(value: Long): Unit               = put(value.toString)
  def double(value: Double): Unit           = put(Json.number(value))
  def longs(values: Vector[Long]): Unit     = put(Json.array(values.map(_.toString)))
  def doubles(values: Vector[Double]): Unit = put(Json.array(values.map(Json.number)))
  def texts(values: Vector[String]): Unit   = put(Json.array(values.map(Json.string)))
  def nothing(): Unit                       = names.next(): Unit

  /** Writes nothing: the bytes have a message of their own. */
  def blob(value: Blob): Unit = names.next(): Unit

  def json: String = Json.obj(fields.result()*)

private[record] object JsonRow:
  /** A table's JSON schema. One type for each field: viewers refuse a list of types. */
  def schema(table: Table[?]): String =
    val fields = table.numbered.filterNot(_.isBlob).map: column =>
      val one = column.sqlType.stripSuffix("[]") match
        case "BIGINT" => "integer"
        case "DOUBLE" => "number"
        case _        => "string"
      val kind =
        if column.sqlType.endsWith("[]") then
          Json.obj("type"    -> "\"array\"", "items" -> Json.obj("type" -> Json.string(one)))
        else Json.obj("type" -> Json.string(one))
      column.name -> kind
    Json.obj(
      "title"      -> Json.string(s"skein.${table.name}"),
      "type"       -> "\"object\"",
      "properties" -> Json.obj(fields*)
    )

  def of(row: Long, record: Record): String =
    val json = JsonRow(Table.of(record).numbered)
    json.long(row)
    Table.columnsOf(record).append(record, json)
    json.json
