/* Whether this machine runs AVX2, by processor and operating system: what sms/_dispatch.py asks before it loads a copy of the
   core. Apart from the core, of which a process can hold one copy only. */
#include <Python.h>

static PyObject *runs_avx2(PyObject *self, PyObject *arguments) {
  (void)self, (void)arguments;
  __builtin_cpu_init();
  return PyBool_FromLong(__builtin_cpu_supports("avx2"));
}

static PyMethodDef functions[] = {
    {"runs_avx2", runs_avx2, METH_NOARGS, "Whether processor and operating system run AVX2."},
    {NULL, NULL, 0, NULL},
};

static struct PyModuleDef module = {
    PyModuleDef_HEAD_INIT, "_cpu", "What the processor runs.", -1, functions, NULL, NULL, NULL, NULL,
};

PyMODINIT_FUNC PyInit__cpu(void) { return PyModule_Create(&module); }
