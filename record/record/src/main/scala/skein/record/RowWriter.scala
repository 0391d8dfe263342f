package skein.record

import org.duckdb.DuckDBAppender
import scala.jdk.CollectionConverters.*

/** Takes the values of one row from left to right. */
private[record] trait RowWriter:
  def text(value: String): Unit
  def long(value: Long): Unit
  def double(value: Double): Unit

  def longs(values: Vector[Long]): Unit
  def doubles(values: Vector[Double]): Unit
  def texts(values: Vector[String]): Unit

  /** Writes bytes; the last value of a row. */
  def blob(value: Blob): Unit

  def nothing(): Unit

  /** An absent value in a column that older formats lack. */
  def nothingYet(): Unit = nothing()

/** Writes values into the appender's current row. */
private[record] final class AppenderRow(appender: DuckDBAppender) extends RowWriter:
  def text(value: String): Unit             = { val _ = appender.append(value) }
  def long(value: Long): Unit               = { val _ = appender.append(value) }
  def double(value: Double): Unit           = { val _ = appender.append(value) }
  def longs(values: Vector[Long]): Unit     = { val _ = appender.append(values.toArray) }
  def doubles(values: Vector[Double]): Unit = { val _ = appender.append(values.toArray) }
  def texts(values: Vector[String]): Unit   = { val _ = appender.append(values.asJava) }
  def blob(value: Blob): Unit               = { val _ = appender.append(value.packed) }
  def nothing(): Unit                       = { val _ = appender.appendNull() }
