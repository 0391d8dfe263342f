package skein.record

/** A closed recording's content: its rows for each table, without the tables that have none. */
final case class Written(rows: Map[String, Long]):
  def total: Long = rows.values.sum

  /** Adds one row for each table name. */
  private[record] def ++(tables: Seq[String]): Written =
    val more = tables.groupMapReduce(identity)(_ => 1)(_ + _)
    Written(more.foldLeft(rows):
      case (rows, (table, count)) => rows.updated(table, rows.getOrElse(table, 0L) + count))

private[skein] object Written:
  val nothing: Written = Written(Map.empty)
