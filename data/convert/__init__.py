"""The forms that people have, as responses: exported files to the response CSV."""

from data.convert.engine import Conversion, convert_files
from data.convert.form import Form
from data.convert.forms import find_form, forms
from data.convert.look import look
from data.convert.map import ConversionMap
from data.convert.map_file import map_text, merged, read_map
from data.convert.options import ConvertOptions, with_options
from data.convert.writing import response_csv

__all__ = [
    "Conversion",
    "ConversionMap",
    "ConvertOptions",
    "Form",
    "convert_files",
    "find_form",
    "forms",
    "look",
    "map_text",
    "merged",
    "read_map",
    "response_csv",
    "with_options",
]
